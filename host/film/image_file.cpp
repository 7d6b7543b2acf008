#include "host/film/image_file.hpp"

#include "host/core/atomic_file.hpp"
#include "host/core/error.hpp"
#include "host/film/crop.hpp"
#include "host/film/exr.hpp"
#include "host/film/png.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <limits>

namespace stromboli {

namespace fs = std::filesystem;

namespace {
enum class Format { Png, Exr };
}

static Format formatOf(const fs::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    if (extension == ".png") return Format::Png;
    if (extension == ".exr") return Format::Exr;
    throw UsageError(fmt::format("{}: unknown kind of picture; the name must end in .png or .exr",
                                 path.string()));
}

void checkWritable(const fs::path& path) {
    formatOf(path);
    checkFileWritable(path);
}

ByteImage toneMap(const Film& film, const Crop& crop, const ToneCurve& tone) {
    const Crop part = cropInside(film, crop);
    ByteImage image(part.width, part.height);
    for (uint32_t y = 0; y < part.height; ++y)
        for (uint32_t x = 0; x < part.width; ++x) {
            const glm::dvec3& mean = film.at(part.x + x, part.y + y).mean;
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
static void fill(FloatImage& image, const std::string& name, const Film& film, const Crop& part,
                 const Value& value) {
    std::vector<float>& channel = image.channel(name);
    for (uint32_t y = 0; y < part.height; ++y)
        for (uint32_t x = 0; x < part.width; ++x)
            channel[size_t(y) * part.width + x] = toFloat(value(film.at(part.x + x, part.y + y)));
}

FloatImage linearPicture(const Film& film, const Crop& crop, bool statistics) {
    const Crop part = cropInside(film, crop);
    FloatImage image(part.width, part.height);
    const char* const names[] = {"R", "G", "B"};
    for (int c = 0; c < 3; ++c)
        fill(image, names[c], film, part, [c](const PixelStatistics& p) { return p.mean[c]; });
    if (!statistics) return image;

    fill(image, "samples", film, part,
         [&](const PixelStatistics& p) { return p.taken() * film.branches; });
    for (int c = 0; c < 3; ++c)
        fill(image, std::string("variance.") + names[c], film, part,
             [c](const PixelStatistics& p) { return p.varianceOfMean()[c]; });
    return image;
}

void writePicture(const fs::path& path, const Film& film, const Crop& crop,
                  const PictureOptions& options) {
    switch (formatOf(path)) {
    case Format::Png:
        writePng(path, toneMap(film, crop, options.tone),
                 options.tone.kind == ToneCurve::Kind::Srgb ? PngColorSpace::Srgb
                                                            : PngColorSpace::Unnamed);
        break;
    case Format::Exr:
        writeExr(path, linearPicture(film, crop, options.statistics));
        break;
    }
}

} // namespace stromboli
