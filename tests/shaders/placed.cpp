#include "tests/shaders/placed.hpp"

#include "host/bvh/wide_layout.hpp"

#include <bit>

namespace stromboli::test {

GpuScene pack(Scene scene) {
    if (scene.materials.empty()) scene.materials.resize(1);
    return packScene(scene, buildWideBvh(scene));
}

std::vector<Placed> placed(const GpuScene& scene) {
    std::vector<Placed> primitives;
    for (const uint32_t place : scene.bvh.placeOf) {
        const gpu::LeafRecord leaf = asLeaf(scene.bvh.records[place / 2]);
        const bool first = place % 2 == 0;
        primitives.push_back({place, (leaf.primitive & gpu::RECORD_IS_SPHERE) != 0, leaf.p0,
                              first ? leaf.p1 : leaf.p2, first ? leaf.p2 : leaf.p3,
                              std::bit_cast<float>(leaf.homeOrRadius)});
    }
    return primitives;
}

} // namespace stromboli::test
