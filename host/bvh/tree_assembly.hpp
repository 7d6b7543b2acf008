#pragma once

#include "host/bvh/wide_layout.hpp"

#include <cstdint>
#include <span>

namespace stromboli::bvh {

/// Puts trees together: one over the world, whose leaves lead to others, and these behind it.
class TreeAssembly {
  public:
    /// world: the tree that has the root; primitiveOf: of the scene, by primitive of that tree.
    /// `scene` must outlive the object.
    TreeAssembly(const Scene& scene, WideLayout world, std::span<const uint32_t> primitiveOf);

    /// Adds a tree; returns the record of its root. primitiveOf: of the scene, by primitive of the
    /// tree.
    uint32_t append(const WideLayout& tree, std::span<const uint32_t> primitiveOf);

    /// Lets the record of a placement lead to the tree of its prototype, which was appended.
    /// box: of the prototype, in its own space.
    void place(uint32_t placement, uint32_t root, const Bounds& box);

    /// Lets the record of a placement be the root of a tree that was appended and is in world
    /// space.
    void join(uint32_t placement, uint32_t root);

    WideLayout finish();

  private:
    const Scene& scene_;
    WideLayout layout_;
    uint32_t levels_ = 0; ///< most stack entries of an appended tree
};

} // namespace stromboli::bvh
