#pragma once

#include "scene/model/scene.hpp"

#include <optional>
#include <vector>

namespace stromboli {

// Prototypes in the world: what their placements make of points, normals and boxes.

/// Where a point of the prototype is in the world: rounded in the same way wherever it is asked
/// for, in the kernel too (shaders/include/placements.glsl), so that all see the same corners.
glm::vec3 placed(const Placement& placement, const glm::vec3& point);

/// The matrix from the prototype to the world, and its inverse. In double: exact, and as good as
/// that.
struct PlacementMatrices {
    glm::dmat3 linear;
    glm::dvec3 offset;
    glm::dmat3 inverseLinear;
    glm::dvec3 inverseOffset; ///< of a point p: inverseLinear * p + inverseOffset
    bool mirrors;             ///< turns right-handed frames into left-handed ones
};
PlacementMatrices matricesOf(const Placement& placement);

/// A matrix for a Placement, rounded to floats. Nothing where it is of no use for one: not finite,
/// without an inverse, or one that stretches some direction 2^16 times as much as another, so that
/// a ray of floats can no longer be told well in the prototype's space (docs/theory/numerics.md,
/// "Instances").
std::optional<Placement> placementOf(const glm::dmat4& toWorld);

/// By prototype: the box of its corners, in its own space.
std::vector<Bounds> prototypeBounds(const Scene& scene);

/// A box in the world that holds all that a box of the prototype holds, with what rounding does to
/// corners.
Bounds boundsInWorld(const Placement& placement, const Bounds& box);

/// A scene in which each placement has triangles of its own, with nothing left to place.
struct ExpandedScene {
    Scene scene;
    /// By triangle of it: the triangle of the original scene, and the placement (kInNoPlacement:
    /// none).
    std::vector<uint32_t> triangleOf, placementOf;
};
inline constexpr uint32_t kInNoPlacement = 0xFFFFFFFFu;

/// Throws SceneError where that makes more than 2^28 triangles.
ExpandedScene expandPlacements(const Scene& scene);

} // namespace stromboli
