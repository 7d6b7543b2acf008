#pragma once

#include "host/compare/metrics.hpp"

#include <random>

namespace stromboli::compare {

inline Picture constantPicture(uint32_t width, uint32_t height, const glm::dvec3& color) {
    Picture picture(width, height);
    picture.rgb.assign(picture.rgb.size(), color);
    return picture;
}

/// Exponential values of the given mean: a long tail, as radiance has.
inline Picture randomPicture(uint32_t width, uint32_t height, unsigned seed, double mean = 0.4) {
    std::mt19937 random(seed);
    std::exponential_distribution<double> value(1 / mean);
    Picture picture(width, height);
    for (glm::dvec3& c : picture.rgb)
        c = {value(random), value(random), value(random)};
    return picture;
}

inline Picture scaled(Picture picture, double factor) {
    for (glm::dvec3& c : picture.rgb)
        c *= factor;
    return picture;
}

/// What tests of acceptance compare with: grey, of kSide x kSide pixels.
inline constexpr uint32_t kSide = 48;
inline Picture greyReference() {
    return constantPicture(kSide, kSide, glm::dvec3(0.5));
}

} // namespace stromboli::compare
