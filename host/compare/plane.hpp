#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace stromboli::compare {

/// One channel of a picture, rows from the top.
struct Plane {
    uint32_t width = 0, height = 0;
    std::vector<double> values;

    Plane() = default;
    Plane(uint32_t w, uint32_t h) : width(w), height(h), values(size_t(w) * h) {}
};

/// Weights at -r, ..., 0, ..., r.
using Kernel = std::vector<double>;

/// exp(-x^2 / (2 sigma^2)) at whole x up to `radius`, with sum 1.
Kernel gaussian(double sigma, int radius);

/// sum of alongX[i] alongY[j] p(x + i, y + j): a correlation, beyond the edges of the plane the
/// nearest value of it.
Plane filter(const Plane& plane, const Kernel& alongX, const Kernel& alongY);

} // namespace stromboli::compare
