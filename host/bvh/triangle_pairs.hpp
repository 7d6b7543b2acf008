#pragma once

#include "scene/model/scene.hpp"

#include <array>
#include <cstdint>
#include <vector>

namespace stromboli::bvh {

/// Two triangles with an edge in common, which they run through in opposite directions; its ends
/// have the same bits in both.
struct TrianglePair {
    std::array<uint32_t, 2> triangle; ///< the lesser number first
    std::array<uint8_t, 2> edge;      ///< the common edge goes from this corner to the next
};

/// Pairs of triangles that are cheaper to visit together than apart: the area of their box is not
/// above the sum of the areas of theirs (SAH). Greedily, the pair that saves most first; each
/// triangle is in one pair at most. Ordered by the first triangle.
std::vector<TrianglePair> pairTriangles(const Scene& scene);

} // namespace stromboli::bvh
