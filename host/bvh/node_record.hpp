#pragma once

#include "scene/model/scene.hpp"
#include "shaders/shared/scene_types.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <optional>

namespace stromboli::bvh {

/// The boxes of a node's children by slot; nothing for absent ones.
using ChildBoxes = std::array<std::optional<Bounds>, gpu::WIDE_CHILDREN>;

/// What every box of a scene is widened by: 2^-32 of the scene's largest coordinate, the way a ray
/// may stray from its line in the box test. docs/numerics.md, "Boxes".
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

} // namespace stromboli::bvh
