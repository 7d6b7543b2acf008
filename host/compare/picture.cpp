#include "host/compare/picture.hpp"

#include "host/core/error.hpp"
#include "host/film/image_file.hpp"
#include "host/film/image_formats.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>

namespace stromboli::compare {
namespace {

namespace fs = std::filesystem;

constexpr const char* kChannels[] = {"R", "G", "B"};

Picture fromBytes(const ByteImage& image) {
    Picture picture(image.width, image.height);
    picture.lowDynamicRange = true;
    for (size_t i = 0; i < picture.rgb.size(); ++i)
        for (int c = 0; c < 3; ++c)
            picture.rgb[i][c] = linearFromSrgb(image.rgb[3 * i + size_t(c)] / 255.0);
    for (size_t i = 0; i < image.alpha.size(); ++i) // as EXR has it: over black
        picture.rgb[i] *= image.alpha[i] / 255.0;
    return picture;
}

bool hasAll(const FloatImage& image, const std::string& prefix) {
    return std::all_of(std::begin(kChannels), std::end(kChannels),
                       [&](const char* color) { return image.channels.contains(prefix + color); });
}

/// The sums that linearPicture() wrote the variances of. The channel "samples" counts paths, of
/// which each sample has as many as branches; and rejected samples too, which are so few that the
/// variance of the rest is not affected.
Film filmOf(const fs::path& path, const Picture& picture, const FloatImage& image) {
    Film film(picture.width, picture.height);
    film.branches = image.branches;
    for (size_t i = 0; i < film.pixels.size(); ++i) {
        const auto value = [&](const std::string& channel, double most) {
            const double v = image.channels.at(channel)[i];
            if (!(v >= 0 && v <= most))
                throw UsageError(fmt::format("{}: the channel {} is {:g} at pixel {} {}: expected "
                                             "a number from 0 to {:g}",
                                             path.string(), channel, v, i % film.width,
                                             i / film.width, most));
            return v;
        };
        PixelStatistics& pixel = film.pixels[i];
        const auto paths = uint32_t(value("samples", std::numeric_limits<uint32_t>::max()));
        pixel.count = paths / image.branches;
        pixel.mean = picture.rgb[i];
        const double n = pixel.count;
        for (int c = 0; c < 3; ++c)
            pixel.m2[c] =
                value(std::string("variance.") + kChannels[c], std::numeric_limits<float>::max()) *
                n * (n - 1);
    }
    return film;
}

Picture fromFloats(const fs::path& path, const FloatImage& image) {
    if (!hasAll(image, ""))
        throw UsageError(fmt::format("{}: expected channels R, G and B", path.string()));
    Picture picture(image.width, image.height);
    for (size_t i = 0; i < picture.rgb.size(); ++i)
        for (int c = 0; c < 3; ++c)
            picture.rgb[i][c] = image.channels.at(kChannels[c])[i];
    if (image.channels.contains("samples") && hasAll(image, "variance."))
        picture.film = filmOf(path, picture, image);
    return picture;
}

} // namespace

Picture readPicture(const fs::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    if (extension == ".png") return fromBytes(readPng(path));
    if (extension == ".exr") return fromFloats(path, readExr(path));
    if (extension == ".pfm") return fromFloats(path, readPfm(path));
    throw UsageError(fmt::format(
        "{}: unknown kind of picture; the name must end in .png, .exr or .pfm", path.string()));
}

Picture pictureOf(Film film) {
    Picture picture(film.width, film.height);
    for (size_t i = 0; i < picture.rgb.size(); ++i)
        picture.rgb[i] = film.pixels[i].mean;
    picture.film = std::move(film);
    return picture;
}

uint64_t countNotFinite(const Picture& picture) {
    return uint64_t(std::count_if(picture.rgb.begin(), picture.rgb.end(), [](const glm::dvec3& c) {
        return !std::isfinite(c.x) || !std::isfinite(c.y) || !std::isfinite(c.z);
    }));
}

} // namespace stromboli::compare
