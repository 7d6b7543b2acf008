#pragma once

#include "scene/build/mesh.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace stromboli::build {

/// How close tubes come to round ones.
struct TubeDetail {
    uint32_t sides = 6;
    double tolerance = 0.1; ///< how far lines may be off a curve, as a share of its width
};

/// Of hair there are millions of segments, which would take gigabytes with six sides: more than so
/// many points have three, and lines that are off by half of a width.
inline constexpr size_t kMostDetailedPoints = 200'000;
TubeDetail tubeDetail(size_t points);

/// A point of a line that has a thickness.
struct Knot {
    glm::dvec3 place{0.0};
    double radius = 0;
};
using Strand = std::vector<Knot>;

/// Adds a tube along a strand of two points or more to the first part of a mesh: of so many sides,
/// three or more, which look round, and in the mean over all directions as wide as a round one. The
/// texture coordinate u runs around it, v along it.
void addTube(Mesh& mesh, const Strand& strand, uint32_t sides);

} // namespace stromboli::build
