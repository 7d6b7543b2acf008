#include "host/bvh/box_grid.hpp"

#include "shaders/shared/scene_types.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace stromboli::bvh {

namespace {

constexpr int kExponentBias = 127;
constexpr int kLeastExponent = -90;
constexpr double kLastPlane = 255;

/// In cells. A position on the grid is a difference of two doubles, off by half an ulp of at
/// most 256 cells, that is 2^-45; 2^-40 more than the margin makes up for it.
constexpr double kMargin = gpu::BOX_MARGIN + 0x1p-40;

constexpr uint32_t kOriginMask = 0xFFFFFF00u;

/// The greatest float not above x whose last 8 bits are 0.
float originNotAbove(double x) {
    float nearest = float(x);
    if (double(nearest) > x) nearest = std::nextafter(nearest, -std::numeric_limits<float>::max());
    const uint32_t bits = std::bit_cast<uint32_t>(nearest);
    // Clearing bits moves it towards 0; below 0 it has to go away from 0.
    const bool awayFromZero = nearest < 0 && (bits & ~kOriginMask) != 0;
    return std::bit_cast<float>((bits & kOriginMask) + (awayFromZero ? ~kOriginMask + 1 : 0));
}

/// 2^n, n being far from the ends of double's range.
double powerOfTwo(int n) {
    return std::bit_cast<double>(uint64_t(n + 1023) << 52);
}

/// In cells from the grid's origin.
double position(const AxisGrid& grid, double x) {
    return (x - double(grid.origin)) * powerOfTwo(kExponentBias - int(grid.exponent));
}

} // namespace

double AxisGrid::cell() const {
    return powerOfTwo(int(exponent) - kExponentBias);
}

uint32_t AxisGrid::word() const {
    return std::bit_cast<uint32_t>(origin) | exponent;
}

AxisGrid AxisGrid::fromWord(uint32_t word) {
    return {std::bit_cast<float>(word & kOriginMask), word & ~kOriginMask};
}

AxisGrid gridOver(double low, double high) {
    const double extent = high - low;
    int exponent = kLeastExponent;
    if (extent > 0) exponent = std::max(exponent, std::ilogb(extent / kLastPlane));
    for (;; ++exponent) {
        const double cell = powerOfTwo(exponent);
        // Twice the margin, so that rounding leaves one of them. Far from 0 origins
        // lie farther apart than the cells: it is then well below, and the cells have to be larger.
        const AxisGrid grid{originNotAbove(low - 2 * kMargin * cell),
                            uint32_t(exponent + kExponentBias)};
        if (position(grid, low) >= kMargin && position(grid, high) + kMargin <= kLastPlane)
            return grid;
    }
}

uint32_t planeBelow(const AxisGrid& grid, double low) {
    return uint32_t(std::floor(position(grid, low) - kMargin));
}

uint32_t planeAbove(const AxisGrid& grid, double high) {
    return uint32_t(std::ceil(position(grid, high) + kMargin));
}

} // namespace stromboli::bvh
