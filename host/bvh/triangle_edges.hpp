#pragma once

#include "scene/model/scene.hpp"

#include <cstdint>
#include <vector>

namespace stromboli::bvh {

inline constexpr uint32_t kNoEdge = 0xFFFFFFFFu;

/// For each edge of each triangle the edge of another triangle that joins the same two positions
/// (bit for bit) in the opposite direction, or kNoEdge. Edge 3 * t + c of triangle t goes from its
/// corner c to the next. Where more than two triangles meet in an edge, some are joined in pairs.
std::vector<uint32_t> oppositeEdges(const Scene& scene);

} // namespace stromboli::bvh
