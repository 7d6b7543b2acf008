#include "scene/model/emitters.hpp"

#include <gtest/gtest.h>

#include <glm/gtc/constants.hpp>

#include <cmath>

namespace stromboli {
namespace {

class Emitters : public testing::Test {
  protected:
    Emitters() {
        scene.materials.resize(3);
        scene.materials[1].emission = glm::vec3(1);
        scene.materials[2].emission = glm::vec3(0, 0, 2);
    }

    void add(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c, uint32_t material,
             uint32_t instance) {
        Triangle t;
        for (int i = 0; i < 3; ++i)
            t.corner[i] = uint32_t(scene.positions.size()) + i;
        for (const glm::vec3& p : {a, b, c})
            scene.positions.push_back(p);
        t.material = material;
        t.instance = instance;
        scene.triangles.push_back(t);
    }

    Scene scene;
};

TEST_F(Emitters, NoneWithoutEmission) {
    add({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0, 0);
    scene.spheres.push_back({});
    EXPECT_TRUE(collectEmitters(scene).empty());
}

TEST_F(Emitters, GroupsByInstanceAndMaterial) {
    add({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 1, 1);
    add({0, 0, 0}, {2, 0, 0}, {0, 1, 0}, 2, 1);
    add({0, 0, 0}, {3, 0, 0}, {0, 1, 0}, 1, 0);
    add({0, 0, 0}, {4, 0, 0}, {0, 1, 0}, 1, 1);
    const std::vector<Emitter> emitters = collectEmitters(scene);
    ASSERT_EQ(emitters.size(), 3u);
    EXPECT_EQ(emitters[0].triangles, (std::vector<uint32_t>{2}));
    EXPECT_EQ(emitters[1].triangles, (std::vector<uint32_t>{0, 3}));
    EXPECT_EQ(emitters[2].triangles, (std::vector<uint32_t>{1}));
    EXPECT_DOUBLE_EQ(emitters[1].area, 0.5 + 2);
    for (const Emitter& e : emitters)
        EXPECT_EQ(e.kind, EmitterKind::Mesh);
}

TEST_F(Emitters, RecognisesParallelogramsFromAnyCorner) {
    const glm::vec3 a(0.1f, 0.2f, 0.3f), b(1.7f, 0.4f, 0.1f), c(2.3f, 1.9f, 0.7f);
    const glm::vec3 d = a + (c - b);
    const glm::vec3 first[] = {a, b, c}, second[] = {c, d, a};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            scene.triangles.clear();
            add(first[i], first[(i + 1) % 3], first[(i + 2) % 3], 1, 0);
            add(second[j], second[(j + 1) % 3], second[(j + 2) % 3], 1, 0);
            const std::vector<Emitter> emitters = collectEmitters(scene);
            ASSERT_EQ(emitters.size(), 1u);
            const Emitter& quad = emitters[0];
            ASSERT_EQ(quad.kind, EmitterKind::Quad) << i << j;
            const glm::dvec3 normal = glm::cross(glm::dvec3(quad.edgeA), glm::dvec3(quad.edgeB));
            EXPECT_NEAR(glm::length(normal), quad.area, 1e-6);
            EXPECT_GT(glm::dot(glm::vec3(normal), scene.geometricNormal(scene.triangles[0])), 0);
        }
}

TEST_F(Emitters, RecognisesParallelogramsRoundedToFloat) {
    // Corners of rotated rectangles, each rounded on its own: none completes another exactly.
    int exact = 0;
    for (int i = 0; i < 100; ++i) {
        const double angle = 0.0617 * i;
        const glm::dvec3 u(std::cos(angle), 0.1, std::sin(angle)), v(0.3, 1, -0.2), o(5, 0.7, -3);
        const glm::vec3 a(o), b(o + u), c(o + u + v), d(o + v);
        exact += a + (c - b) == d;
        scene.triangles.clear();
        add(a, b, c, 1, 0);
        add(c, d, a, 1, 0);
        EXPECT_EQ(collectEmitters(scene).at(0).kind, EmitterKind::Quad) << i;
    }
    EXPECT_LT(exact, 90) << "the case shows nothing";
}

TEST_F(Emitters, OtherPairsAreMeshes) {
    const auto kind = [&](const glm::vec3& d, bool folded = false) {
        scene.triangles.clear();
        add({0, 0, 0}, {1, 0, 0}, {1, 1, 0}, 1, 0);
        if (folded)
            add({1, 1, 0}, {0, 0, 0}, d, 1, 0); // the other way round
        else
            add({1, 1, 0}, d, {0, 0, 0}, 1, 0);
        return collectEmitters(scene).at(0).kind;
    };
    EXPECT_EQ(kind({0, 1, 0}), EmitterKind::Quad);
    EXPECT_EQ(kind({0, 1, 1e-5f}), EmitterKind::Mesh);
    EXPECT_EQ(kind({0, 1.00001f, 0}), EmitterKind::Mesh);
    EXPECT_EQ(kind({0, 1, 0}, true), EmitterKind::Mesh);
}

TEST_F(Emitters, Spheres) {
    Sphere dark, bright;
    bright.radius = 2;
    bright.material = 2;
    scene.spheres = {dark, bright};
    const std::vector<Emitter> emitters = collectEmitters(scene);
    ASSERT_EQ(emitters.size(), 1u);
    EXPECT_EQ(emitters[0].kind, EmitterKind::Sphere);
    EXPECT_EQ(emitters[0].sphere, 1u);
    EXPECT_EQ(emitters[0].material, 2u);
    EXPECT_NEAR(emitters[0].area, 16 * glm::pi<double>(), 1e-12);
}

} // namespace
} // namespace stromboli
