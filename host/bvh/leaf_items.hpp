#pragma once

#include "scene/model/scene.hpp"
#include "shaders/shared/scene_types.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace stromboli::bvh {

/// What one leaf record holds: two triangles that share an edge, a triangle, a sphere, or a
/// placement. The tree is built over these.
struct LeafItem {
    /// Scene primitives (triangles first, then spheres) in slots 0 and 1; NO_PRIMITIVE: none.
    std::array<uint32_t, 2> primitive{gpu::NO_PRIMITIVE, gpu::NO_PRIMITIVE};
    /// Which corner of the triangle is the slot's first.
    std::array<uint8_t, 2> firstCorner{0, 0};
    /// Of an item without primitives: in Scene::placements.
    uint32_t placement = kNoPlacement;

    static constexpr uint32_t kNoPlacement = 0xFFFFFFFFu;
    bool isPlacement() const { return placement != kNoPlacement; }
    /// Of primitives.
    uint32_t count() const { return isPlacement() ? 0 : primitive[1] == gpu::NO_PRIMITIVE ? 1 : 2; }
};

/// All primitives of the scene, each in one item: first the items with triangles, then the spheres.
std::vector<LeafItem> makeLeafItems(const Scene& scene);

/// The items' boxes: those of their primitives together.
std::vector<Bounds> itemBounds(const Scene& scene, std::span<const LeafItem> items);

} // namespace stromboli::bvh
