// How primitives are packed for the device.
#include "host/bvh/wide_layout.hpp"
#include "host/kernel/gpu_scene.hpp"

#include <gtest/gtest.h>

namespace stromboli {
namespace {

/// A flat triangle brings its normal, a smooth one those of its corners; a light's leaf names it.
TEST(PackedPrimitives, HaveTheirNormalsAndNameTheirLights) {
    Material metal, emitter;
    metal.kind = MaterialKind::Conductor;
    metal.facets = {FacetDistribution::Beckmann, glm::vec2(0.1f)};
    emitter.emission = glm::vec3(1);
    Scene scene;
    scene.materials = {metal, emitter};
    scene.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 4}, {4, 0, 4}, {0, 4, 7}};
    const glm::vec3 smooth = glm::normalize(glm::vec3(1, 2, 3));
    scene.normals = {smooth};
    scene.triangles = {{{0, 1, 2}}, {{3, 4, 5}, {0, 0, 0}, 1}};
    scene.instances = {"triangles"};
    const GpuScene packed = packScene(scene, buildWideBvh(scene));
    EXPECT_TRUE(packed.hasNormals);
    for (size_t i = 0; i < 2; ++i) {
        const gpu::Primitive& p = packed.primitives[i];
        const uint32_t id = packed.bvh.primitiveOrder[i], place = packed.bvh.placeOf[id];
        const bool isEmitter = id == 1;
        const gpu::LeafRecord leaf = asLeaf(packed.bvh.records[place / 2]);
        EXPECT_EQ(place % 2 == 0 ? leaf.light0 : leaf.light1, isEmitter ? 0 : gpu::NO_LIGHT);
        EXPECT_EQ(materialHeader(packed, p).emission, glm::vec3(isEmitter));
        EXPECT_EQ((p.material & gpu::PRIMITIVE_IS_SMOOTH) != 0, isEmitter);
        if (isEmitter)
            EXPECT_LT(glm::distance(decodeNormal(p.n2), smooth), 1e-4f);
        else
            EXPECT_EQ(glm::uintBitsToFloat(glm::uvec3(p.n0, p.n1, p.n2)), glm::vec3(0, 0, 1));
    }
}

} // namespace
} // namespace stromboli
