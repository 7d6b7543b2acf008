#pragma once

#include "host/bvh/binary_tree.hpp"
#include "host/bvh/split_items.hpp"
#include "scene/model/scene.hpp"
#include "shaders/shared/scene_types.h"

#include <array>
#include <bit>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace stromboli {

// --- The layout ----------------------------------------------------------------------------------

/// 64 bytes: a gpu::NodeRecord or a gpu::LeafRecord.
using Record = std::array<uint32_t, sizeof(gpu::NodeRecord) / sizeof(uint32_t)>;

inline gpu::NodeRecord asNode(const Record& r) {
    return std::bit_cast<gpu::NodeRecord>(r);
}
inline gpu::LeafRecord asLeaf(const Record& r) {
    return std::bit_cast<gpu::LeafRecord>(r);
}
inline gpu::PlacementRecord asPlacement(const Record& r) {
    return std::bit_cast<gpu::PlacementRecord>(r);
}
inline uint32_t kindOf(const Record& r) {
    return asNode(r).firstChild & gpu::RECORD_IS_PLACEMENT;
}
inline bool isNode(const Record& r) {
    return kindOf(r) == gpu::RECORD_IS_NODE;
}
inline bool isPlacement(const Record& r) {
    return kindOf(r) == gpu::RECORD_IS_PLACEMENT;
}

/// The tree as the kernel reads it: 8-wide, boxes on a grid of 8 bits per axis (after Ylitie,
/// Karras and Laine 2017). Prototypes have trees of their own behind the tree over the world, whose
/// leaves lead to them; the records of transformations come last. Where an animation moves things,
/// the tree over the world has that over what stands still as one of its subtrees.
struct WideLayout {
    std::vector<Record> records;          ///< record 0: the root, always a node
    std::vector<uint32_t> primitiveOrder; ///< entry i of the Primitive buffer is order[i]
    /// By scene primitive: 2 * record + slot in the leaf, the first where there are several.
    std::vector<uint32_t> placeOf;
    /// By scene primitive: the slot's corner c is corner (c + firstCorner) % 3 of the triangle.
    std::vector<uint8_t> firstCorner;
    /// Entries the kernel's stack needs: those that can wait at once, and one that it writes
    /// beyond them without keeping it.
    uint32_t stackSize = 1;
    std::vector<uint32_t> recordOfPlacement; ///< by placement
};

class KeptTrees; // two_level_layout.hpp

/// The tree over all primitives and placements of the scene (triangles first, then spheres). Throws
/// SceneError where it has more records than gpu::MAX_RECORDS, and what buildBinaryTree throws.
/// kept: trees of other moments of the same animation, to which those of this one are added; the
/// layout is the same with and without them.
WideLayout buildWideBvh(const Scene& scene, const BuildOptions& options = {},
                        KeptTrees* kept = nullptr);

} // namespace stromboli

namespace stromboli::bvh {

// --- Writing it ----------------------------------------------------------------------------------

/// The layout of a tree over the boxes of leaf items of the scene. An item with several boxes has a
/// leaf for each, and all of these name the first. The records of placements are there, but for
/// what they lead to. itemOf: by box (ItemBoxes). padding: of its boxes; by default that of the
/// tree's own box (boxPadding()), which is enough where the tree is all that rays meet in its
/// space.
WideLayout writeLayout(const Scene& scene, std::span<const LeafItem> items,
                       std::span<const uint32_t> itemOf, const BinaryTree& tree,
                       std::optional<double> padding = {});

} // namespace stromboli::bvh
