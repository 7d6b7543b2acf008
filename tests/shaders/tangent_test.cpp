// Tangents of corners, as the kernel reads them, against those of the scene.
#include "tests/shaders/texture_lookup.hpp"

#include "host/core/random.hpp"
#include "scene/model/surface_lookup.hpp"
#include "tests/analytic/textured.hpp"

#include <cmath>

namespace stromboli::test {
namespace {

class CornerTangents : public TextureLookup {};

/// Unit vectors: along the axes, near them, and others.
glm::vec3 direction(Random& random, uint32_t i) {
    glm::dvec3 v = random.vector();
    if (i % 3 == 0) v = glm::dvec3(i / 3 % 3 == 0, i / 3 % 3 == 1, i / 3 % 3 == 2);
    if (i % 3 == 1) v[int(i / 3 % 3)] *= 1e-4;
    return glm::vec3(glm::normalize(i % 2 == 0 ? v : -v));
}

/// Each component within half of the 8191st of 1 that it is rounded to; the side of the bitangent,
/// or that a corner has no tangent and there is none.
TEST_P(CornerTangents, AreThoseOfTheScene) {
    constexpr uint32_t kTriangles = 600;
    Random random(29);
    SceneMaker b;
    TextureMaker t(b.scene);
    Material m;
    m.kind = MaterialKind::Principled;
    m.principled.anisotropy = 0.5f;
    const uint32_t material = b.add(m);
    uint32_t corners = 0;
    for (uint32_t i = 0; i < kTriangles; ++i) {
        const auto z = float(i);
        b.triangle({0, 0, z}, {1, 0, z}, {0, 1, z}, material);
        t.attributes(1, [&](const glm::vec3& p) {
            // Without texture coordinates a corner that states no tangent has none.
            const bool isStated = i % 50 != 0 || p.x == 0;
            const float side = i % 2 == 0 ? 1.0f : -1.0f;
            VertexAttributes a;
            a.tangent = {direction(random, corners++), isStated ? side : 0.0f};
            return a;
        });
    }
    scene_ = b.scene;
    pack();
    ASSERT_TRUE(packed_.attributes & gpu::ATTRIBUTE_TANGENT);
    std::vector<TextureQuery> queries;
    for (uint32_t i = 0; i < kTriangles; ++i)
        for (uint32_t c = 0; c < 3; ++c)
            queries.push_back({i, 0, 0, gpu::TANGENT_OF_CORNER + c});
    const std::vector<TextureAnswer> found = ask(queries);
    for (uint32_t i = 0; i < kTriangles; ++i) {
        const uint32_t id = packed_.bvh.primitiveOrder[i];
        glm::vec4 stated[3];
        bool isComplete = true;
        for (uint32_t c = 0; c < 3; ++c) {
            stated[c] = tangentAtCorner(scene_, id, (c + packed_.bvh.firstCorner[id]) % 3, 0);
            isComplete &= stated[c].w != 0;
        }
        for (uint32_t c = 0; c < 3; ++c) {
            const TextureAnswer& a = found[3 * i + c];
            EXPECT_EQ(a.alpha, isComplete ? stated[c].w : 0.0f) << id;
            for (int k = 0; k < 3 && isComplete; ++k)
                ASSERT_NEAR(a.color[k] / 8191, stated[c][k], (0.5 + 1e-3) / 8191)
                    << "triangle " << id << ", corner " << c << ", component " << k;
        }
    }
}

INSTANTIATE_TEST_SUITE_P(Fetch, CornerTangents,
                         testing::Values(TextureStorage{true, Gathered::All},
                                         TextureStorage{false, Gathered::All}),
                         [](const auto& p) { return p.param.texelBuffers ? "Texel" : "Storage"; });

} // namespace
} // namespace stromboli::test
