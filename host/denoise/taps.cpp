#include "host/denoise/taps.hpp"

#include <algorithm>
#include <cstdlib>

namespace stromboli::denoise {
namespace {

/// Within so many columns and rows all neighbours are taken.
constexpr int kDense = 4;
constexpr int kStep = 2;
/// Deviations of the candidates' weights by distance, in pixels.
constexpr double kStrict = 4, kWide = 8;

/// A Gaussian's.
float exponent(int square, double deviation) {
    return float(square / (2 * deviation * deviation));
}

} // namespace

std::vector<gpu::DenoiseTap> taps() {
    std::vector<gpu::DenoiseTap> all;
    for (int dy = -kReach; dy <= kReach; ++dy)
        for (int dx = -kReach; dx <= kReach; ++dx) {
            const int square = dx * dx + dy * dy;
            if (square > kReach * kReach) continue;
            const bool isNear = std::max(std::abs(dx), std::abs(dy)) <= kDense;
            if (!isNear && (dx % kStep != 0 || dy % kStep != 0)) continue;
            gpu::DenoiseTap tap{};
            tap.dx = float(dx), tap.dy = float(dy);
            tap.strict = exponent(square, kStrict), tap.wide = exponent(square, kWide);
            tap.times = isNear ? 1 : kStep * kStep;
            all.push_back(tap);
        }
    return all;
}

} // namespace stromboli::denoise
