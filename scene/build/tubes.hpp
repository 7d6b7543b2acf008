#pragma once

#include "scene/build/mesh.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <vector>

namespace stromboli::build {

inline constexpr uint32_t kTubeSides = 6;

/// A point of a line that has a thickness.
struct Knot {
    glm::dvec3 place{0.0};
    double radius = 0;
};
using Strand = std::vector<Knot>;

/// Adds a tube along a strand of two points or more to the first part of a mesh: of six sides that
/// look round, and in the mean over all directions as wide as a round one. The texture coordinate u
/// runs around it, v along it.
void addTube(Mesh& mesh, const Strand& strand);

} // namespace stromboli::build
