#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace stromboli::build {

/// Cuts a polygon of three or more finite corners into triangles between its corners (no new
/// points, so that neighbours still meet along whole edges), in the polygon's own sense of
/// rotation. Appends them as corner numbers. A polygon that is not plane is cut as its projection
/// along the largest component of its normal. Returns false if the polygon crosses itself; it is
/// then cut somehow.
bool triangulate(std::span<const glm::dvec3> polygon,
                 std::vector<std::array<uint32_t, 3>>& triangles);

} // namespace stromboli::build
