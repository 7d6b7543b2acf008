#pragma once

#include "host/bvh/wide_layout.hpp"

#include <array>
#include <cstdint>

namespace stromboli {

struct BvhStatistics {
    uint32_t nodes = 0, leaves = 0; ///< of the tree over the world, without those of prototypes
    uint32_t placements = 0;
    uint32_t depth = 0;                     ///< edges on the longest path from the root
    std::array<uint32_t, 9> nodesOfSize{};  ///< [n]: nodes with n children
    std::array<uint32_t, 3> leavesOfSize{}; ///< [n]: leaves with n primitives
    /// Records a random line through the root's box is expected to visit without an end to it
    /// (Goldsmith and Salmon 1987): the areas of all records' boxes, as the kernel has them,
    /// over the root's. Node and leaf records count alike: the kernel does the same for both. 1 if
    /// the root has no area.
    double expectedVisits = 0;
    uint64_t recordBytes = 0;
    uint64_t primitives = 0;

    double childrenPerNode() const;
    double primitivesPerLeaf() const;
    /// Bytes of the records and of a gpu::Primitive, divided by the number of primitives; 0 if
    /// there are none.
    double bytesPerPrimitive() const;
};

BvhStatistics measure(const WideLayout& layout);

} // namespace stromboli
