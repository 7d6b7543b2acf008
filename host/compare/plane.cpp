#include "host/compare/plane.hpp"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace stromboli::compare {
namespace {

/// Filters along x and exchanges x and y: done twice, it filters along both.
Plane filterAndTranspose(const Plane& plane, const Kernel& kernel) {
    Plane out(plane.height, plane.width);
    const int radius = int(kernel.size() / 2), last = int(plane.width) - 1;
    tbb::parallel_for(uint32_t(0), plane.height, [&](uint32_t y) {
        const double* row = &plane.values[size_t(y) * plane.width];
        for (int x = 0; x <= last; ++x) {
            double sum = 0;
            for (int i = -radius; i <= radius; ++i)
                sum += kernel[size_t(i + radius)] * row[std::clamp(x + i, 0, last)];
            out.values[size_t(x) * plane.height + y] = sum;
        }
    });
    return out;
}

} // namespace

Kernel gaussian(double sigma, int radius) {
    Kernel kernel;
    double sum = 0;
    for (int x = -radius; x <= radius; ++x) {
        kernel.push_back(std::exp(-x * x / (2 * sigma * sigma)));
        sum += kernel.back();
    }
    for (double& weight : kernel)
        weight /= sum;
    return kernel;
}

Plane filter(const Plane& plane, const Kernel& alongX, const Kernel& alongY) {
    return filterAndTranspose(filterAndTranspose(plane, alongX), alongY);
}

} // namespace stromboli::compare
