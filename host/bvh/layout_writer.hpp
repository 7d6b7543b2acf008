#pragma once

#include "host/bvh/leaf_items.hpp"
#include "host/bvh/wide_layout.hpp"

#include <optional>
#include <span>

namespace stromboli::bvh {

/// The layout of a tree over leaf items of the scene. The records of placements are there, but for
/// what they lead to. padding: of its boxes; by default that of the tree's own box (boxPadding()),
/// which is enough where the tree is all that rays meet in its space.
WideLayout writeLayout(const Scene& scene, std::span<const LeafItem> items, const BinaryTree& tree,
                       std::optional<double> padding = {});

} // namespace stromboli::bvh
