#pragma once

#include <algorithm>
#include <cmath>

namespace stromboli {

/// Linear light of an sRGB value, both in [0, 1] (IEC 61966-2-1).
inline double srgbToLinear(double value) {
    return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
}

/// The inverse of srgbToLinear.
inline double linearToSrgb(double light) {
    return light <= 0.0031308 ? light * 12.92 : 1.055 * std::pow(light, 1 / 2.4) - 0.055;
}

} // namespace stromboli
