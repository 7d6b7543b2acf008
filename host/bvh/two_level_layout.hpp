#pragma once

#include "host/bvh/wide_layout.hpp"

namespace stromboli::bvh {

/// The layout of a scene with placements: a tree over its triangles and spheres in the world and
/// its placements, and one for each prototype.
WideLayout buildTwoLevels(const Scene& scene, const BuildOptions& options);

} // namespace stromboli::bvh
