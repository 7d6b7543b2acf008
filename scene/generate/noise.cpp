#include "scene/generate/noise.hpp"

#include <cmath>
#include <cstdint>

namespace stromboli {

/// A number in [-1, 1] for a lattice point, by mixing its coordinates' bits.
static double latticeValue(int64_t x, int64_t y) {
    uint64_t bits = uint64_t(x) * 0x9E3779B97F4A7C15u ^ uint64_t(y) * 0xD1B54A32D192ED03u;
    bits = (bits ^ bits >> 29) * 0xBF58476D1CE4E5B9u;
    bits = (bits ^ bits >> 32) * 0x94D049BB133111EBu;
    bits ^= bits >> 30;
    return double(bits >> 11) * 0x1p-52 - 1;
}

/// Goes from 0 to 1 with first and second derivatives of 0 at both ends.
static double ease(double t) {
    return t * t * t * (t * (t * 6 - 15) + 10);
}

double valueNoise(const glm::dvec2& p) {
    const glm::dvec2 cell = glm::floor(p);
    const double u = ease(p.x - cell.x), v = ease(p.y - cell.y);
    const auto x = int64_t(cell.x), y = int64_t(cell.y);
    const double below = glm::mix(latticeValue(x, y), latticeValue(x + 1, y), u);
    const double above = glm::mix(latticeValue(x, y + 1), latticeValue(x + 1, y + 1), u);
    return glm::mix(below, above, v);
}

/// Weighted sum of fold(noise) over the octaves. Each is turned and moved, so that no lattice
/// directions show.
template <typename Fold>
static double octaveSum(glm::dvec2 p, int octaves, const Fold& fold) {
    double sum = 0, weights = 0, weight = 1;
    for (int i = 0; i < octaves; ++i) {
        sum += weight * fold(valueNoise(p));
        weights += weight;
        weight /= 2;
        p = glm::dvec2(1.6 * p.x - 1.2 * p.y + 17.3, 1.2 * p.x + 1.6 * p.y - 9.1); // length 2
    }
    return sum / weights;
}

double fractalNoise(const glm::dvec2& p, int octaves) {
    return octaveSum(p, octaves, [](double noise) { return noise; });
}

double ridgedNoise(const glm::dvec2& p, int octaves) {
    return octaveSum(p, octaves, [](double noise) { return 1 - std::hypot(noise, 0.15); });
}

} // namespace stromboli
