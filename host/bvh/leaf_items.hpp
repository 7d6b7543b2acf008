#pragma once

#include "scene/model/scene.hpp"
#include "shaders/shared/scene_types.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace stromboli {

// --- Bounds of primitives ------------------------------------------------------------------------

/// The box of one primitive of the scene: triangles are 0..nt-1, then spheres nt..nt+ns-1. The
/// primitive lies wholly inside: a triangle's box is exact, a sphere's is rounded outward. NaN
/// where a corner is not finite.
Bounds primitiveBounds(const Scene& scene, uint32_t primitive);

} // namespace stromboli

namespace stromboli::bvh {

// --- Pairs of triangles --------------------------------------------------------------------------

/// Two triangles with an edge in common, which they run through in opposite directions; its ends
/// have the same bits in both.
struct TrianglePair {
    std::array<uint32_t, 2> triangle; ///< the lesser number first
    std::array<uint8_t, 2> edge;      ///< the common edge goes from this corner to the next
};

/// Pairs of triangles that are cheaper to visit together than apart: the area of their box is not
/// above the sum of the areas of theirs (SAH). Greedily, the pair that saves most first; each
/// triangle is in one pair at most. Ordered by the first triangle.
std::vector<TrianglePair> pairTriangles(const Scene& scene);

// --- Items of leaves -----------------------------------------------------------------------------

/// What one leaf record holds: two triangles that share an edge, a triangle, a sphere, or a
/// placement. The tree is built over these.
struct LeafItem {
    /// Scene primitives (triangles first, then spheres) in slots 0 and 1; NO_PRIMITIVE: none.
    std::array<uint32_t, 2> primitive{gpu::NO_PRIMITIVE, gpu::NO_PRIMITIVE};
    /// Which corner of the triangle is the slot's first.
    std::array<uint8_t, 2> firstCorner{0, 0};
    /// Index into Scene::placements, if the item is a placement and has no primitives.
    uint32_t placement = kNoPlacement;

    static constexpr uint32_t kNoPlacement = 0xFFFFFFFFu;
    bool isPlacement() const { return placement != kNoPlacement; }
    /// How many primitives the item has, 0 to 2.
    uint32_t count() const { return isPlacement() ? 0 : primitive[1] == gpu::NO_PRIMITIVE ? 1 : 2; }
};

/// All primitives of the scene, each in one item: first the items with triangles, then the spheres.
std::vector<LeafItem> makeLeafItems(const Scene& scene);

/// The items' boxes: those of their primitives together.
std::vector<Bounds> itemBounds(const Scene& scene, std::span<const LeafItem> items);

} // namespace stromboli::bvh
