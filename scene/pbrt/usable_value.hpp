#pragma once

#include <algorithm>
#include <cmath>

namespace stromboli::pbrt {

/// What a grid of a file has at a place, as it counts: 0 for what is negative or no number.
inline float usable(double value) {
    return std::isfinite(value) && value > 0 ? float(std::min(value, 1e30)) : 0;
}

} // namespace stromboli::pbrt
