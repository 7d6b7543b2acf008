#include "host/film/image_file.hpp"

#include "host/core/error.hpp"
#include "host/core/files.hpp"
#include "host/film/image_formats.hpp"

#include <fmt/format.h>

#include <cctype>
#include <limits>
#include <optional>

namespace stromboli {

// --- Picture files -------------------------------------------------------------------------------

namespace fs = std::filesystem;

static std::optional<PictureFormat> formatNamedBy(const fs::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension == ".png") return PictureFormat::Png;
    if (extension == ".exr") return PictureFormat::Exr;
    if (extension == ".jpg" || extension == ".jpeg") return PictureFormat::Jpeg;
    if (extension == ".webp") return PictureFormat::WebP;
    return std::nullopt;
}

PictureFormat formatOf(const fs::path& path) {
    if (isStandardOutput(path)) return PictureFormat::Png;
    if (const std::optional<PictureFormat> format = formatNamedBy(path)) return *format;
    throw UsageError(fmt::format("{}: unknown kind of picture; the name must end in .png, .exr, "
                                 ".jpg, .jpeg or .webp",
                                 path.string()));
}

bool namesPicture(const fs::path& path) {
    return formatNamedBy(path).has_value();
}

bool isToneMapped(const fs::path& path) {
    return formatOf(path) != PictureFormat::Exr;
}

void checkWritable(const fs::path& path) {
    formatOf(path);
    checkOutputWritable(path);
}

void checkPictureSize(const fs::path& path, uint32_t width, uint32_t height) {
    const PictureFormat format = formatOf(path);
    if (format != PictureFormat::Jpeg && format != PictureFormat::WebP) return;
    const uint32_t most = format == PictureFormat::Jpeg ? kLargestJpegSide : kLargestWebPSide;
    if (width > most || height > most)
        throw UsageError(fmt::format(
            "{}: the picture has {} x {} pixels, and {} holds at most {} a "
            "side: write .png or .exr",
            path.string(), width, height, format == PictureFormat::Jpeg ? "JPEG" : "WebP", most));
}

uint64_t largestPictureFile(const fs::path& path, uint32_t width, uint32_t height,
                            const PictureOptions& options, const PictureNotes& notes) {
    const uint64_t pixels = uint64_t(width) * height;
    uint64_t headers = 4096;              // bytes; a few hundred are used
    for (const PictureNote& note : notes) // PNG takes at most 17 bytes around each, EXR 13
        headers += note.name.size() + note.text.size() + 17;
    const PictureFormat format = formatOf(path);
    if (format == PictureFormat::Png) {
        // A byte before each row names its filter.
        const uint64_t filtered =
            (options.hasAlpha() ? 4 : 3) * (options.encoding.bits / 8) * pixels + height;
        // zlib's compressBound(); libpng frames every 8192 bytes by 12 more.
        const uint64_t compressed = filtered + (filtered >> 12) + (filtered >> 14) + 13;
        return compressed + 12 * (compressed / 8192 + 1) + headers;
    }
    // What libjpeg-turbo reserves for any picture whose colours are kept for each pixel
    // (tjBufSize()): 6 bytes for each pixel of whole blocks. WebP's are fewer.
    if (format == PictureFormat::Jpeg || format == PictureFormat::WebP)
        return 6 * (uint64_t(width) + 7) * (uint64_t(height) + 7) + headers;
    // Blocks of 16 rows that ZIP does not make smaller are kept as they are; each has its place and
    // size, and an entry in the table of blocks.
    const uint64_t channels = (options.statistics ? 7 : 3) + options.channels.size();
    const uint64_t blocks = height / 16 + 1;
    return channels * 4 * pixels + blocks * (8 + 8) + headers;
}

PictureNotes readPictureNotes(const fs::path& path) {
    switch (formatOf(path)) {
    case PictureFormat::Png:
        return readPngNotes(path);
    case PictureFormat::Exr:
        return readExrNotes(path);
    case PictureFormat::Jpeg:
        return readJpegNotes(path);
    case PictureFormat::WebP:
        return readWebPNotes(path);
    }
    return {};
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

static PngColorSpace colorSpaceOf(const ToneCurve& curve) {
    return curve.kind == ToneCurve::Kind::Srgb ? PngColorSpace::Srgb : PngColorSpace::Unnamed;
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
    const auto& names = kColorChannels;
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
    if (mapsAtOnce()) {
        bytes_ = ByteImage(part.width, part.height);
        if (options_.hasAlpha()) bytes_.alpha.resize(area.pixelCount());
        return;
    }
    floats_ = FloatImage(area); // place() makes the channels of EXR files
    if (!isToneMapped(path_)) return;
    for (const char* name : kColorChannels)
        floats_.channel(name);
    if (options_.hasAlpha()) floats_.channel(kAlphaChannel);
}

bool PictureFile::mapsAtOnce() const {
    return isToneMapped(path_) && options_.tone.isCurveAlone() && options_.encoding.isUsual();
}

void PictureFile::place(const Film& film, const FloatImage& more) {
    const size_t first = size_t(film.area.rendered().y - area_.rendered().y) * film.width;
    if (mapsAtOnce()) {
        std::span<const float> alpha;
        if (options_.hasAlpha()) alpha = more.channels.at(kAlphaChannel);
        const ByteImage part = toneMap(film, options_.tone.curve, alpha);
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

namespace {

/// Writes a picture of 8 bits a channel.
void writeBytes(const fs::path& path, const ByteImage& image, const PictureOptions& options,
                const PictureNotes& notes) {
    switch (formatOf(path)) {
    case PictureFormat::Jpeg:
        return writeJpeg(path, image, options.encoding.quality, notes);
    case PictureFormat::WebP:
        return writeWebP(path, image, options.encoding.quality, notes);
    case PictureFormat::Png:
    case PictureFormat::Exr:
        break;
    }
    writePng(path, image, colorSpaceOf(options.tone.curve), notes);
}

} // namespace

ToneMapping PictureFile::write(const PictureNotes& notes) const {
    if (!isToneMapped(path_))
        writeExr(path_, floats_, notes);
    else if (mapsAtOnce())
        writeBytes(path_, bytes_, options_, notes);
    else
        return writeToneMapped(path_, floats_, options_, notes);
    return options_.tone;
}

ToneMapping writeToneMapped(const fs::path& path, const FloatImage& radiance,
                            const PictureOptions& options, const PictureNotes& notes) {
    const ToneMapping tone = resolved(options.tone, radiance);
    const bool dithers = options.encoding.dithers;
    if (options.encoding.bits == 16)
        writePng(path, toneMap<uint16_t>(radiance, tone, dithers), colorSpaceOf(tone.curve), notes);
    else
        writeBytes(path, toneMap<uint8_t>(radiance, tone, dithers), options, notes);
    return tone;
}

void writePicture(const fs::path& path, const Film& film, const PictureOptions& options) {
    PictureFile file(path, film.area, options);
    file.place(film);
    file.write();
}

} // namespace stromboli
