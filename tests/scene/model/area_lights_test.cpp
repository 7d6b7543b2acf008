#include "scene/model/area_lights.hpp"
#include "scene/model/emitters.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace stromboli {
namespace {

Light areaLight() {
    Light light;
    light.name = "Light";
    light.kind = LightKind::Area;
    light.color = glm::vec3(3, 4, 5);
    light.position = {0, 1.5f, 0};
    light.direction = {0, -1, 0};
    light.edgeX = {0.6f, 0, 0};
    light.edgeY = {0, 0, 0.8f};
    return light;
}

/// A rectangle of 0.8 x 0.6 about (x, y, 0), facing down.
void addMesh(Scene& scene, float x, float y, const glm::vec3& emission) {
    Material material;
    material.emission = emission;
    scene.materials.push_back(material);
    scene.instances.push_back("mesh");
    const auto first = uint32_t(scene.positions.size());
    for (const glm::vec3& p : {glm::vec3(-.4f, 0, -.3f), glm::vec3(.4f, 0, -.3f),
                               glm::vec3(.4f, 0, .3f), glm::vec3(-.4f, 0, .3f)})
        scene.positions.push_back(p + glm::vec3(x, y, 0));
    for (const auto& corners : {std::array{0u, 1u, 2u}, std::array{0u, 2u, 3u}}) {
        Triangle t;
        for (int i = 0; i < 3; ++i)
            t.corner[i] = first + corners[i];
        t.material = uint32_t(scene.materials.size() - 1);
        t.instance = uint32_t(scene.instances.size() - 1);
        scene.triangles.push_back(t);
    }
}

TEST(AreaLights, BecomeOneSidedEmitters) {
    for (bool swapped : {false, true}) {
        Scene scene;
        scene.lights = {areaLight()};
        if (swapped) std::swap(scene.lights[0].edgeX, scene.lights[0].edgeY);
        resolveAreaLights(scene);
        EXPECT_TRUE(scene.lights.empty());
        ASSERT_EQ(scene.triangles.size(), 2u);
        const std::vector<Emitter> emitters = collectEmitters(scene);
        ASSERT_EQ(emitters.size(), 1u);
        EXPECT_EQ(emitters[0].kind, EmitterKind::Quad);
        EXPECT_NEAR(emitters[0].area, 0.48, 1e-6);
        const Material& material = scene.materials.at(emitters[0].material);
        EXPECT_EQ(material.emission, glm::vec3(3, 4, 5));
        EXPECT_EQ(material.albedo, glm::vec3(0));
        EXPECT_FALSE(material.emitsBothSides);
        for (const Triangle& t : scene.triangles)
            EXPECT_LT(scene.geometricNormal(t).y, -0.999f);
        const glm::vec3 center = 0.5f * (scene.bounds().lo + scene.bounds().hi);
        EXPECT_LT(glm::distance(center, glm::vec3(0, 1.5f, 0)), 1e-6f);
    }
}

TEST(AreaLights, AreTheMeshInTheirPlace) {
    for (float y : {1.5f, 1.502f}) {
        Scene scene;
        addMesh(scene, 0, y, glm::vec3(10));
        scene.lights = {areaLight()};
        resolveAreaLights(scene);
        EXPECT_TRUE(scene.lights.empty());
        EXPECT_EQ(scene.triangles.size(), 2u);
        EXPECT_EQ(collectEmitters(scene).size(), 1u);
        EXPECT_THAT(scene.report.ignored, testing::ElementsAre(testing::HasSubstr("'Light'")));
    }
}

TEST(AreaLights, OtherMeshesAreNotThem) {
    const auto emittersWith = [](float x, float y, const glm::vec3& emission) {
        Scene scene;
        addMesh(scene, x, y, emission);
        scene.lights = {areaLight()};
        resolveAreaLights(scene);
        EXPECT_TRUE(scene.lights.empty());
        return collectEmitters(scene).size();
    };
    EXPECT_EQ(emittersWith(0, 1.5f, glm::vec3(0)), 1u) << "does not emit";
    EXPECT_EQ(emittersWith(0, 1.4f, glm::vec3(1)), 2u) << "in another plane";
    EXPECT_EQ(emittersWith(1, 1.5f, glm::vec3(1)), 2u) << "beside it";
    EXPECT_EQ(emittersWith(0, 1.5f, glm::vec3(1)), 1u);
}

TEST(AreaLights, OtherLightsStay) {
    Scene scene;
    Light point;
    point.name = "Point";
    scene.lights = {point, areaLight(), point};
    resolveAreaLights(scene);
    ASSERT_EQ(scene.lights.size(), 2u);
    EXPECT_EQ(scene.lights[0].kind, LightKind::Point);
    EXPECT_EQ(scene.lights[1].name, "Point");
}

} // namespace
} // namespace stromboli
