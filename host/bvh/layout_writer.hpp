#pragma once

#include "host/bvh/leaf_items.hpp"
#include "host/bvh/wide_layout.hpp"

#include <span>

namespace stromboli::bvh {

/// The layout of a tree over leaf items of the scene. The records of placements are there, but for
/// what they lead to.
WideLayout writeLayout(const Scene& scene, std::span<const LeafItem> items, const BinaryTree& tree);

} // namespace stromboli::bvh
