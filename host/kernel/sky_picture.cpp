#include "host/kernel/sky_picture.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <numeric>

namespace stromboli {

SkyPicture::SkyPicture(const EnvironmentTable& table)
    : table_(table), tiles_(table.tileProbability.size()) {
    std::partial_sum(table.tileProbability.begin(), table.tileProbability.end(), tiles_.begin());
}

/// The texel as pickEnvironmentTexel() of shaders/lights/environment.glsl picks it, then a point of
/// it.
glm::dvec3 SkyPicture::sample(Random& random) const {
    const gpu::EnvironmentLight& e = table_.light;
    const auto at = std::ranges::upper_bound(tiles_, random.uniform() * tiles_.back());
    const uint32_t tile = std::min(uint32_t(at - tiles_.begin()), e.tiles - 1),
                   side = 1u << e.tileShift, left = tile % e.tilesAcross * side,
                   top = tile / e.tilesAcross * side;
    uint32_t x = left + random.below(std::min(side, e.width - left)),
             y = top + random.below(std::min(side, e.height - top));
    const auto texel = std::bit_cast<gpu::EnvironmentTexel>(
        (*table_.texels)[gpu::ENVIRONMENT_COLUMN_ROWS + size_t(y) * e.width + x]);
    if (random.uniform() >= texel.threshold) x = texel.alias % e.width, y = texel.alias / e.width;
    const double around = ((x + double(random.uniform())) / e.width - 0.5) * 2 * std::numbers::pi;
    // Turned back at the poles, of whose rows half is there.
    const double span = table_.rows.span(),
                 below = std::abs(y + double(random.uniform()) - table_.rows.pole()),
                 polar = std::min(below, 2 * span - below) / span * std::numbers::pi;
    const glm::dvec3 d(std::sin(around) * std::sin(polar), std::cos(polar),
                       -std::cos(around) * std::sin(polar));
    const double c = e.cosRotation, s = e.sinRotation;
    return {c * d.x + s * d.z, d.y, c * d.z - s * d.x};
}

} // namespace stromboli
