#include "host/film/image_file.hpp"

#include "host/core/error.hpp"
#include "host/core/files.hpp"
#include "host/film/image_formats.hpp"

#include <fmt/format.h>

#include <cctype>
#include <cmath>
#include <limits>
#include <numbers>
#include <optional>

namespace stromboli {

// --- Tone curves ---------------------------------------------------------------------------------

/// Clamps to [0, 1]; NaN gives 0.
static double unitInterval(double value) {
    if (!(value > 0)) return 0;
    return value < 1 ? value : 1;
}

double srgbFromLinear(double linear) {
    const double l = unitInterval(linear);
    return l <= 0.0031308 ? 12.92 * l : 1.055 * std::pow(l, 1 / 2.4) - 0.055;
}

double linearFromSrgb(double signal) {
    const double s = unitInterval(signal);
    return s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4);
}

double radianceFromCs184(uint8_t byte) {
    return std::pow((byte + 0.5) / 255, 2.2) / std::numbers::sqrt2;
}

uint8_t ToneCurve::toByte(double radiance) const {
    if (!(radiance > 0)) return 0;
    const double exposed = std::exp2(exposure) * radiance;
    if (kind == Kind::Srgb) return static_cast<uint8_t>(255 * srgbFromLinear(exposed) + 0.5);
    const double signal = std::pow(std::numbers::sqrt2 * exposed, 1 / 2.2);
    return static_cast<uint8_t>(255 * unitInterval(signal));
}

// --- Images in memory ----------------------------------------------------------------------------

std::vector<float>& FloatImage::channel(const std::string& name) {
    return channels.try_emplace(name, size_t(width) * height).first->second;
}

// --- Picture files -------------------------------------------------------------------------------

namespace fs = std::filesystem;

namespace {
enum class Format { Png, Exr };
}

static std::optional<Format> formatNamedBy(const fs::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension == ".png") return Format::Png;
    if (extension == ".exr") return Format::Exr;
    return std::nullopt;
}

static Format formatOf(const fs::path& path) {
    if (isStandardOutput(path)) return Format::Png;
    if (const std::optional<Format> format = formatNamedBy(path)) return *format;
    throw UsageError(fmt::format("{}: unknown kind of picture; the name must end in .png or .exr",
                                 path.string()));
}

bool namesPicture(const fs::path& path) {
    return formatNamedBy(path).has_value();
}

bool isPng(const fs::path& path) {
    return formatOf(path) == Format::Png;
}

void checkWritable(const fs::path& path) {
    formatOf(path);
    checkOutputWritable(path);
}

uint64_t largestPictureFile(const fs::path& path, uint32_t width, uint32_t height,
                            const PictureOptions& options, const PictureNotes& notes) {
    const uint64_t pixels = uint64_t(width) * height;
    uint64_t headers = 4096;              // bytes; a few hundred are used
    for (const PictureNote& note : notes) // PNG takes at most 17 bytes around each, EXR 13
        headers += note.name.size() + note.text.size() + 17;
    if (formatOf(path) == Format::Png) {
        // A byte before each row names its filter.
        const uint64_t filtered = (options.hasAlpha() ? 4 : 3) * pixels + height;
        // zlib's compressBound(); libpng frames every 8192 bytes by 12 more.
        const uint64_t compressed = filtered + (filtered >> 12) + (filtered >> 14) + 13;
        return compressed + 12 * (compressed / 8192 + 1) + headers;
    }
    // Blocks of 16 rows that ZIP does not make smaller are kept as they are; each has its place and
    // size, and an entry in the table of blocks.
    const uint64_t channels = (options.statistics ? 7 : 3) + options.channels.size();
    const uint64_t blocks = height / 16 + 1;
    return channels * 4 * pixels + blocks * (8 + 8) + headers;
}

PictureNotes readPictureNotes(const fs::path& path) {
    return isPng(path) ? readPngNotes(path) : readExrNotes(path);
}

/// Pixel filters that are negative in places overshoot at edges.
static float clampedAlpha(float alpha) {
    return std::clamp(alpha, 0.0f, 1.0f);
}

/// The colour of the part of a pixel that is covered.
static glm::dvec3 colorOf(const glm::dvec3& mean, double alpha) {
    return alpha > 0 ? mean / alpha : glm::dvec3(0.0);
}

ByteImage toneMap(const Film& film, const ToneCurve& tone, std::span<const float> alpha) {
    ByteImage image(film.width, film.height);
    for (const float a : alpha)
        image.alpha.push_back(uint8_t(255 * clampedAlpha(a) + 0.5f));
    for (uint32_t y = 0; y < film.height; ++y)
        for (uint32_t x = 0; x < film.width; ++x) {
            glm::dvec3 mean = film.at(x, y).mean;
            if (!alpha.empty())
                mean = colorOf(mean, clampedAlpha(alpha[size_t(y) * film.width + x]));
            uint8_t* pixel = image.pixel(x, y);
            for (int c = 0; c < 3; ++c)
                pixel[c] = tone.toByte(mean[c]);
        }
    return image;
}

/// A variance, the square of a radiance, may exceed what a float holds.
static float toFloat(double value) {
    return static_cast<float>(std::min(value, double(std::numeric_limits<float>::max())));
}

/// Fills one channel of the image with a function of each pixel's statistics.
template <typename Value>
static void fill(FloatImage& image, const std::string& name, const Film& film, const Value& value) {
    std::vector<float>& channel = image.channel(name);
    for (size_t i = 0; i < film.pixels.size(); ++i)
        channel[i] = toFloat(value(film.pixels[i]));
}

FloatImage linearPicture(const Film& film, bool statistics) {
    FloatImage image(film.area);
    const char* const names[] = {"R", "G", "B"};
    for (int c = 0; c < 3; ++c)
        fill(image, names[c], film, [c](const PixelStatistics& p) { return p.mean[c]; });
    if (!statistics) return image;

    image.branches = film.branches;
    fill(image, "samples", film,
         [&](const PixelStatistics& p) { return p.taken() * film.branches; });
    for (int c = 0; c < 3; ++c)
        fill(image, std::string("variance.") + names[c], film,
             [c](const PixelStatistics& p) { return p.varianceOfMean()[c]; });
    return image;
}

PictureFile::PictureFile(fs::path path, const PictureArea& area, const PictureOptions& options)
    : path_(std::move(path)), options_(options), area_(area) {
    const Crop part = area.rendered();
    if (isPng(path_)) {
        bytes_ = ByteImage(part.width, part.height);
        if (options_.hasAlpha()) bytes_.alpha.resize(area.pixelCount());
    } else {
        floats_ = FloatImage(area); // place() makes the channels
    }
}

void PictureFile::place(const Film& film, const FloatImage& more) {
    const size_t first = size_t(film.area.rendered().y - area_.rendered().y) * film.width;
    if (isPng(path_)) {
        std::span<const float> alpha;
        if (options_.hasAlpha()) alpha = more.channels.at(kAlphaChannel);
        const ByteImage part = toneMap(film, options_.tone, alpha);
        std::copy(part.rgb.begin(), part.rgb.end(), bytes_.rgb.begin() + std::ptrdiff_t(3 * first));
        std::copy(part.alpha.begin(), part.alpha.end(),
                  bytes_.alpha.begin() + std::ptrdiff_t(first));
        return;
    }
    FloatImage part = linearPicture(film, options_.statistics);
    part.channels.insert(more.channels.begin(), more.channels.end());
    floats_.branches = part.branches;
    for (const auto& [name, values] : part.channels)
        std::copy(values.begin(), values.end(),
                  floats_.channel(name).begin() + std::ptrdiff_t(first));
}

void PictureFile::write(const PictureNotes& notes) const {
    if (isPng(path_))
        writePng(path_, bytes_,
                 options_.tone.kind == ToneCurve::Kind::Srgb ? PngColorSpace::Srgb
                                                             : PngColorSpace::Unnamed,
                 notes);
    else
        writeExr(path_, floats_, notes);
}

void writePicture(const fs::path& path, const Film& film, const PictureOptions& options) {
    PictureFile file(path, film.area, options);
    file.place(film);
    file.write();
}

} // namespace stromboli
