#include "host/bvh/leaf_items.hpp"

#include "host/bvh/primitive_bounds.hpp"
#include "host/bvh/triangle_pairs.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

namespace stromboli::bvh {

std::vector<LeafItem> makeLeafItems(const Scene& scene) {
    std::vector<LeafItem> items;
    std::vector<bool> paired(scene.triangles.size(), false);
    for (const TrianglePair& pair : pairTriangles(scene)) {
        // The shared edge goes from edge[0] to the next corner in the first triangle, and is the
        // side from p2 to p0 there: p0 is the corner after edge[0]. In the second it goes from p0
        // to p2, which are that triangle's first two.
        items.push_back({pair.triangle, {uint8_t((pair.edge[0] + 1) % 3), pair.edge[1]}});
        for (const uint32_t triangle : pair.triangle)
            paired[triangle] = true;
    }
    for (uint32_t i = 0; i < scene.triangles.size(); ++i)
        if (!paired[i]) items.push_back({{i, gpu::NO_PRIMITIVE}, {0, 0}});
    for (uint32_t i = 0; i < scene.spheres.size(); ++i)
        items.push_back({{uint32_t(scene.triangles.size()) + i, gpu::NO_PRIMITIVE}, {0, 0}});
    return items;
}

std::vector<Bounds> itemBounds(const Scene& scene, std::span<const LeafItem> items) {
    std::vector<Bounds> bounds(items.size());
    tbb::parallel_for(tbb::blocked_range<size_t>(0, items.size(), 1u << 12), [&](const auto& r) {
        for (size_t i = r.begin(); i != r.end(); ++i) {
            bounds[i] = primitiveBounds(scene, items[i].primitive[0]);
            if (items[i].count() == 2)
                bounds[i].extend(primitiveBounds(scene, items[i].primitive[1]));
        }
    });
    return bounds;
}

} // namespace stromboli::bvh
