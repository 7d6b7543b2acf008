#pragma once

#include "host/bvh/kept_trees.hpp"
#include "host/bvh/wide_layout.hpp"

namespace stromboli::bvh {

/// The layout of a scene with placements, or of a moment of an animation: a tree over its triangles
/// and spheres in the world and its placements, and one for each prototype; where things move, also
/// one for the triangles in the world that stand still, which the tree over the world leads to.
WideLayout buildTwoLevels(const Scene& scene, const BuildOptions& options, KeptTrees* kept);

} // namespace stromboli::bvh
