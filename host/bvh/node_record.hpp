#pragma once

#include "host/bvh/wide_tree.hpp"
#include "scene/model/scene.hpp"
#include "shaders/shared/scene_types.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace stromboli::bvh {

// --- Boxes on a node's grid ----------------------------------------------------------------------

// Boxes on the grid of a node: a byte for each plane (gpu::NodeRecord). docs/theory/numerics.md,
// "Boxes", derives the margins.

/// The grid of a node on one axis: plane q lies at origin + q * cell, q = 0..255.
struct AxisGrid {
    float origin = 0;        ///< 16 significant bits: the last 8 of its 32 are 0
    uint32_t exponent = 127; ///< cell = 2^(exponent - 127); 1..254

    double cell() const;
    /// Both in one word, as gpu::NodeRecord has them.
    uint32_t word() const;
    static AxisGrid fromWord(uint32_t word);
};

/// The finest grid on which every interval within [low, high] has both bytes below. Cells are
/// at least 2^-90, so that the kernel's products with them stay normal numbers.
AxisGrid gridOver(double low, double high);

/// The highest plane that is BOX_MARGIN cells or more below `low`; `low` must lie within what
/// the grid was made for.
uint32_t planeBelow(const AxisGrid& grid, double low);

/// The lowest plane that is BOX_MARGIN cells or more above `high`.
uint32_t planeAbove(const AxisGrid& grid, double high);

// --- Node records --------------------------------------------------------------------------------

/// The boxes of a node's children by slot; nothing for absent ones.
using ChildBoxes = std::array<std::optional<Bounds>, gpu::WIDE_CHILDREN>;

/// What every box of a scene is widened by: 2^-32 of the scene's largest coordinate, the way a ray
/// may stray from its line in the box test. docs/theory/numerics.md, "Boxes".
double boxPadding(const Bounds& scene);

/// A node with its children's boxes on its grid, each widened by `padding` and by 2^-21 of its
/// largest extent, the way the triangle test may stray.
gpu::NodeRecord packNode(const ChildBoxes& children, uint32_t firstChild, double padding);

/// A box of a node as the kernel decodes it, but in double, where it is exact.
struct GridBox {
    glm::dvec3 lo{1e300}, hi{-1e300};
    bool empty() const { return lo.x > hi.x; }
    void extend(const GridBox& b) { lo = glm::min(lo, b.lo), hi = glm::max(hi, b.hi); }
};

/// Empty for an absent child.
GridBox childBox(const gpu::NodeRecord& node, uint32_t slot);

uint32_t firstChild(const gpu::NodeRecord& node);

// --- Places of records ---------------------------------------------------------------------------

/// Where a node and its children are put in the list of records.
struct NodePlace {
    uint32_t record;
    uint32_t firstChild; ///< its child in slot s is record firstChild + s
};

struct RecordPacking {
    std::vector<NodePlace> places; ///< by node
    uint32_t records = 0;          ///< with gaps, and all that any firstChild + 7 names
    uint32_t depth = 0;            ///< of the inner nodes: edges from the root
};

/// Packs the children of each node in turn (depth first, as collapse() gives them). Gaps are
/// filled by children of later nodes as long as they are near: first fit among the last 256
/// records (16 KB). Where a slot of a node is absent there is never the record of another node,
/// but a leaf or nothing: a ray far away, against whose distance the node is small, may take the
/// absent child's inverted box for hit (docs/theory/numerics.md, "Boxes"). A leaf too many does no
/// harm; nodes could lead it in circles.
RecordPacking packRecords(std::span<const WideNode> nodes);

} // namespace stromboli::bvh
