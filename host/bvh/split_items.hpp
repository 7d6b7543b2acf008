#pragma once

#include "host/bvh/binary_tree.hpp"
#include "host/bvh/leaf_items.hpp"
#include "scene/model/scene.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace stromboli::bvh {

// --- Items in several places of the tree ---------------------------------------------------------

/// The boxes that a tree is built over. An item whose box is mostly empty (a long triangle that is
/// askew to the axes) has several, each of which holds a part of it; together they hold all of it.
struct ItemBoxes {
    std::vector<Bounds> boxes;
    std::vector<uint32_t> itemOf; ///< by box; the first boxes are those of items 0, 1, 2, ...
};

/// Splits the boxes of triangles where that saves rays most visits (after Ernst and Greiner 2007,
/// "Early split clipping"; planes on a grid over the scene as in Karras and Aila 2013, "Fast
/// Parallel Construction of High-Quality Bounding Volume Hierarchies", section 4.4, so that the
/// parts of neighbours end at one plane). The parts are wider than what they hold by how far the
/// triangle test may stray (docs/theory/numerics.md, "Boxes"). Spheres and placements are not
/// split. `boxes`: the items' own. The same for any number of threads.
ItemBoxes splitItems(const Scene& scene, std::span<const LeafItem> items, std::vector<Bounds> boxes,
                     const SplitOptions& options);

} // namespace stromboli::bvh
