#pragma once

#include "host/bvh/binary_tree.hpp"
#include "shaders/shared/scene_types.h"

#include <cstdint>
#include <vector>

namespace stromboli {

/// The tree as the kernel reads it: an array of nodes without pointers, primitives in leaf order.
struct BinaryLayout {
    std::vector<gpu::Node> nodes;         ///< never empty; node 0 is the root
    std::vector<uint32_t> primitiveOrder; ///< kernel primitive i is scene primitive order[i]
    uint32_t stackSize = 1; ///< entries a traversal that pushes the farther child never exceeds
};

BinaryLayout layOut(const BinaryTree& tree);

} // namespace stromboli
