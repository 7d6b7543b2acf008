#include "host/denoise/noisy_picture.hpp"

#include "host/core/error.hpp"
#include "host/denoise/gap_filling.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

namespace stromboli::denoise {
namespace {

using Channel = std::vector<float>;
/// The channels of a vector.
using Triple = std::array<const Channel*, 3>;

const Channel* find(const FloatImage& image, const std::string& name) {
    const auto found = image.channels.find(name);
    return found == image.channels.end() ? nullptr : &found->second;
}

/// The first of several layers that is there with all three channels, by any of the endings.
std::optional<Triple> findTriple(const FloatImage& image, std::initializer_list<const char*> layers,
                                 std::initializer_list<const char*> endings) {
    for (const char* layer : layers)
        for (const std::string_view ending : endings) {
            Triple triple{};
            for (size_t c = 0; c < 3; ++c) {
                const std::string prefix = *layer ? std::string(layer) + "." : "";
                triple[c] = find(image, prefix + ending[c]);
            }
            if (triple[0] && triple[1] && triple[2]) return triple;
        }
    return std::nullopt;
}

std::vector<glm::vec3> valuesOf(const Triple& channels) {
    std::vector<glm::vec3> values(channels[0]->size());
    for (size_t i = 0; i < values.size(); ++i)
        values[i] = {(*channels[0])[i], (*channels[1])[i], (*channels[2])[i]};
    return values;
}

/// Words that know nothing of each other for numbers that follow each other (Wellons 2018,
/// lowbias32).
uint32_t hash32(uint32_t x) {
    x = (x ^ (x >> 16)) * 0x7FEB352Du;
    x = (x ^ (x >> 15)) * 0x846CA68Bu;
    return x ^ (x >> 16);
}

/// A number of mean 0 and variance 1, nearly normal: the sum of twelve uniform ones, less 6. It is
/// made of sums alone, so that it is the same on every machine.
float normalNumber(uint32_t pixel, uint32_t channel) {
    uint64_t sum = 0;
    for (uint32_t i = 0; i < 12; ++i)
        sum += hash32(hash32(pixel * 3 + channel) + i);
    return float(double(sum) * 0x1p-32 - 6.0);
}

/// 1 or -1. Where a deviation is known but for its sign, which half is which is drawn: a sign that
/// all neighbours share would not average out.
float signOf(uint32_t pixel) {
    return hash32(pixel) & 1u ? 1.0f : -1.0f;
}

bool isFinite(const glm::vec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

const glm::vec3 kNotKnown(std::numeric_limits<float>::quiet_NaN());

void takeLayers(NoisyPicture& picture, const FloatImage& image) {
    const auto albedo =
        findTriple(image, {"albedo", "Albedo", "Denoising Albedo", "ViewLayer.Denoising Albedo"},
                   {"RGB", "rgb"});
    const auto normal = findTriple(image,
                                   {"normal", "Normal", "Denoising Normal",
                                    "ViewLayer.Denoising Normal", "sh_normal", "Ns", "N"},
                                   {"XYZ", "RGB", "xyz", "rgb"});
    const Channel* depth = nullptr;
    for (const char* name : {"depth.Z", "Z", "depth.Y", "ViewLayer.Denoising Depth.Z",
                             "ViewLayer.Depth.Z", "ViewLayer.Depth.V"})
        if (!depth) depth = find(image, name);
    if (albedo) picture.albedo = valuesOf(*albedo);
    if (normal) picture.normal = valuesOf(*normal);
    if (depth) picture.depth = *depth;
}

/// Means of two equal halves.
void takeHalves(NoisyPicture& picture, const Triple& a, const Triple& b) {
    const std::vector<glm::vec3> first = valuesOf(a), second = valuesOf(b);
    for (size_t i = 0; i < first.size(); ++i) {
        picture.mean.push_back(0.5f * (first[i] + second[i]));
        picture.deviation.push_back(0.5f * (first[i] - second[i]));
    }
}

/// Two pictures of independent errors are made of one whose variance is known: with a normal number
/// of that variance added and taken away, mean + deviation and mean - deviation do not know each
/// other if the error is normal (Oliveira, Lei and Tibshirani 2021, "Unbiased risk estimation in
/// the normal means problem via coupled bootstrap techniques").
void takeVariance(NoisyPicture& picture, const Triple& variance) {
    const std::vector<glm::vec3> values = valuesOf(variance);
    picture.variance = values;
    for (uint32_t i = 0; i < values.size(); ++i) {
        glm::vec3 d;
        for (uint32_t c = 0; c < 3; ++c)
            d[int(c)] = std::sqrt(std::max(values[i][int(c)], 0.0f)) * normalNumber(i, c);
        picture.deviation.push_back(isFinite(values[i]) ? d : kNotKnown);
    }
}

/// What cannot be looked at gets NaN in its mean, once for all.
void markUnknown(NoisyPicture& picture) {
    for (size_t i = 0; i < picture.mean.size(); ++i) {
        if (isFinite(picture.mean[i]) && isFinite(picture.deviation[i])) continue;
        picture.mean[i] = kNotKnown;
        picture.deviation[i] = glm::vec3(0.0f);
        ++picture.unknownPixels;
    }
}

} // namespace

NoisyPicture noisyPictureOf(const Film& film, std::span<const glm::dvec3> squaredErrors,
                            const FloatImage& layers) {
    NoisyPicture picture{film.width, film.height};
    picture.errorShare = sharesOfErrors(film, squaredErrors);
    picture.mean.reserve(film.pixels.size());
    picture.deviation.reserve(film.pixels.size());
    for (uint32_t i = 0; i < film.pixels.size(); ++i) {
        const bool isKnown = film.pixels[i].count >= 2;
        picture.mean.push_back(isKnown ? glm::vec3(film.pixels[i].mean) : kNotKnown);
        picture.deviation.push_back(signOf(i) * glm::vec3(glm::sqrt(squaredErrors[i])));
        picture.variance.emplace_back(film.pixels[i].varianceOfMean());
    }
    takeLayers(picture, layers);
    markUnknown(picture);
    return picture;
}

NoisyPicture noisyPictureOf(const FloatImage& image, const std::string& file) {
    NoisyPicture picture{image.width, image.height};
    const auto halfA = findTriple(image, {"halfA", "colorA", "A"}, {"RGB"});
    const auto halfB = findTriple(image, {"halfB", "colorB", "B"}, {"RGB"});
    const auto color = findTriple(
        image, {"noisy", "", "color", "Color", "ViewLayer.Combined", "Combined", "beauty", "rgba"},
        {"RGB", "rgb"});
    const auto deviation = findTriple(image, {"deviation"}, {"RGB"});
    const auto variance = findTriple(image, {"variance"}, {"RGB"});
    std::vector<std::string> names;
    for (const auto& channel : image.channels)
        names.push_back(channel.first);
    if (halfA && halfB) {
        takeHalves(picture, *halfA, *halfB);
    } else if (!color) {
        throw UsageError(
            fmt::format("{}: it has no channels R, G, B, but {}", file, fmt::join(names, ", ")));
    } else {
        picture.mean = valuesOf(*color);
        if (deviation)
            picture.deviation = valuesOf(*deviation);
        else if (variance)
            takeVariance(picture, *variance);
        else
            throw UsageError(fmt::format(
                "{}: how noisy it is cannot be told: it has neither variance.R, .G, .B (render "
                "--aov) nor halfA.R, ... and halfB.R, ..., but {}",
                file, fmt::join(names, ", ")));
    }
    takeLayers(picture, image);
    markUnknown(picture);
    return picture;
}

} // namespace stromboli::denoise
