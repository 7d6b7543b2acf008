#include "host/compare/metrics.hpp"

#include "host/compare/flip.hpp"
#include "host/core/color.hpp"
#include "host/core/error.hpp"
#include "host/film/image_formats.hpp"
#include "scene/images/float_image.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace stromboli::compare {

// --- Pictures ------------------------------------------------------------------------------------

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

/// A picture of a kind that films are not written in. Over black, as EXR has it.
Picture fromOthers(const fs::path& path, bool lowDynamicRange) {
    try {
        const images::RadiancePicture read = images::readRadiance(path);
        for (const images::PictureFault& fault : read.faults)
            throw UsageError(fmt::format("{}: {}: expected a whole picture to compare",
                                         path.string(), fault.problem));
        Picture picture(read.width, read.height);
        picture.lowDynamicRange = lowDynamicRange;
        for (size_t i = 0; i < picture.rgb.size(); ++i)
            picture.rgb[i] = glm::vec3(read.texels[i]);
        return picture;
    } catch (const SceneError& error) { // it is no scene
        throw UsageError(error.what());
    }
}

bool hasAll(const FloatImage& image, const std::string& prefix) {
    return std::all_of(std::begin(kChannels), std::end(kChannels),
                       [&](const char* color) { return image.channels.contains(prefix + color); });
}

/// The sums that linearPicture() wrote the variances of. The channel "samples" counts paths, of
/// which each sample has as many as branches; and rejected samples too, which are so few that the
/// variance of the rest is not affected.
Film filmOf(const std::string& name, const Picture& picture, const FloatImage& image) {
    Film film(picture.width, picture.height);
    film.branches = image.branches;
    for (size_t i = 0; i < film.pixels.size(); ++i) {
        const auto value = [&](const std::string& channel, double most) {
            const double v = image.channels.at(channel)[i];
            if (!(v >= 0 && v <= most))
                throw UsageError(fmt::format("{}: the channel {} is {:g} at pixel {} {}: expected "
                                             "a number from 0 to {:g}",
                                             name, channel, v, i % film.width, i / film.width,
                                             most));
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

} // namespace

Picture pictureOf(const FloatImage& image, const std::string& name) {
    if (!hasAll(image, "")) throw UsageError(fmt::format("{}: expected channels R, G and B", name));
    Picture picture(image.width, image.height);
    for (size_t i = 0; i < picture.rgb.size(); ++i)
        for (int c = 0; c < 3; ++c)
            picture.rgb[i][c] = image.channels.at(kChannels[c])[i];
    if (image.channels.contains("samples") && hasAll(image, "variance."))
        picture.film = filmOf(name, picture, image);
    return picture;
}

Picture readPicture(const fs::path& path) {
    std::string extension = path.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    if (extension == ".png") return fromBytes(readPng(path));
    if (extension == ".exr") return pictureOf(readExr(path), path.string());
    if (extension == ".pfm") return pictureOf(readPfm(path), path.string());
    if (extension == ".hdr") return fromOthers(path, false);
    for (const char* bytes : {".jpg", ".jpeg", ".webp", ".bmp", ".gif"})
        if (extension == bytes) return fromOthers(path, true);
    throw UsageError(fmt::format("{}: unknown kind of picture; the name must end in .png, .jpg, "
                                 ".webp, .bmp, .gif, .exr, .hdr or .pfm",
                                 path.string()));
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

// --- Metrics -------------------------------------------------------------------------------------

namespace {

void requireSameSize(const Picture& a, const Picture& b) {
    if (a.width != b.width || a.height != b.height)
        throw std::invalid_argument("the pictures to compare have different sizes");
}

double relativeError(const glm::dvec3& r, const glm::dvec3& x, double epsilon) {
    double sum = 0;
    for (int c = 0; c < 3; ++c) {
        const double d = x[c] - r[c];
        // Equal values have no error, in a reference that is black everywhere too (0 / 0).
        if (d != 0) sum += d * d / (r[c] * r[c] + epsilon);
    }
    return sum / 3;
}

} // namespace

double relativeEpsilon(const Picture& reference) {
    double sum = 0;
    for (const glm::dvec3& r : reference.rgb)
        sum += r.x + r.y + r.z;
    const double mean = reference.rgb.empty() ? 0 : sum / (3 * double(reference.rgb.size()));
    return 0.01 * mean * mean;
}

LinearErrors linearErrors(const Picture& reference, const Picture& picture) {
    requireSameSize(reference, picture);
    LinearErrors errors;
    errors.epsilon = relativeEpsilon(reference);
    glm::dvec3 squares(0), differences(0), means(0);
    for (size_t i = 0; i < reference.rgb.size(); ++i) {
        const glm::dvec3& r = reference.rgb[i];
        const glm::dvec3 d = picture.rgb[i] - r;
        squares += d * d;
        differences += d;
        means += r;
        errors.relMse += relativeError(r, picture.rgb[i], errors.epsilon);
    }
    const double n = double(reference.rgb.size());
    errors.mse = (squares.x + squares.y + squares.z) / (3 * n);
    errors.relMse /= n;
    for (int c = 0; c < 3; ++c) {
        errors.bias[size_t(c)] = differences[c] / n;
        errors.relativeBias[size_t(c)] = differences[c] == 0 ? 0 : differences[c] / means[c];
    }
    return errors;
}

std::vector<double> relativeErrorMap(const Picture& reference, const Picture& picture) {
    requireSameSize(reference, picture);
    const double epsilon = relativeEpsilon(reference);
    std::vector<double> map(reference.rgb.size());
    for (size_t i = 0; i < map.size(); ++i)
        map[i] = relativeError(reference.rgb[i], picture.rgb[i], epsilon);
    return map;
}

double psnr(const Picture& reference, const Picture& picture, double stops) {
    requireSameSize(reference, picture);
    const double exposure = std::exp2(stops);
    double sum = 0;
    for (size_t i = 0; i < reference.rgb.size(); ++i)
        for (int c = 0; c < 3; ++c) {
            const double d = srgbFromLinear(exposure * picture.rgb[i][c]) -
                             srgbFromLinear(exposure * reference.rgb[i][c]);
            sum += d * d;
        }
    const double mse = sum / (3 * double(reference.rgb.size()));
    return mse > 0 ? -10 * std::log10(mse) : std::numeric_limits<double>::infinity();
}

namespace {

Plane greySignal(const Picture& picture, double stops) {
    const double exposure = std::exp2(stops);
    Plane grey(picture.width, picture.height);
    for (size_t i = 0; i < grey.values.size(); ++i) {
        const glm::dvec3 c = exposure * picture.rgb[i];
        grey.values[i] = luminance({srgbFromLinear(c.x), srgbFromLinear(c.y), srgbFromLinear(c.z)});
    }
    return grey;
}

Plane product(const Plane& a, const Plane& b) {
    Plane p(a.width, a.height);
    for (size_t i = 0; i < p.values.size(); ++i)
        p.values[i] = a.values[i] * b.values[i];
    return p;
}

} // namespace

double ssim(const Picture& reference, const Picture& picture, double stops) {
    constexpr double kC1 = 0.01 * 0.01, kC2 = 0.03 * 0.03;
    const Kernel window = gaussian(1.5, 5);
    const auto smooth = [&](const Plane& p) { return filter(p, window, window); };
    const Plane a = greySignal(reference, stops), b = greySignal(picture, stops);
    const Plane meanA = smooth(a), meanB = smooth(b);
    const Plane squareA = smooth(product(a, a)), squareB = smooth(product(b, b)),
                mixed = smooth(product(a, b));
    double sum = 0;
    for (size_t i = 0; i < a.values.size(); ++i) {
        const double ma = meanA.values[i], mb = meanB.values[i];
        const double varianceA = squareA.values[i] - ma * ma;
        const double varianceB = squareB.values[i] - mb * mb;
        const double covariance = mixed.values[i] - ma * mb;
        sum += (2 * ma * mb + kC1) * (2 * covariance + kC2) /
               ((ma * ma + mb * mb + kC1) * (varianceA + varianceB + kC2));
    }
    return sum / double(a.values.size());
}

} // namespace stromboli::compare
