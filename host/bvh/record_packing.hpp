#pragma once

#include "host/bvh/wide_tree.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace stromboli::bvh {

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
/// absent child's inverted box for hit (docs/numerics.md, "Boxes"). A leaf too many does no
/// harm; nodes could lead it in circles.
RecordPacking packRecords(std::span<const WideNode> nodes);

} // namespace stromboli::bvh
