// How lights are picked where the user leaves it open (Packer::suitableChoice in light_table.cpp).
#include "host/bvh/wide_layout.hpp"
#include "host/kernel/gpu_scene.hpp"
#include "scene/generate/scene_maker.hpp"

#include <gtest/gtest.h>

namespace stromboli::test {
namespace {

using namespace scenes;

/// A floor of 1 m, and two emissive triangles a metre above it under a picture of radiance 1.
struct SceneUnderSky {
    explicit SceneUnderSky(float emission) {
        Material white, light;
        light.emission = glm::vec3(emission);
        const uint32_t diffuse = maker.add(white), emitter = maker.add(light);
        maker.triangle({0, 0, 0}, {0, 0, 1}, {1, 0, 0}, diffuse);
        for (const float x : {0.0f, 0.5f})
            maker.triangle({x, 1, 0}, {x + 0.2f, 1, 0}, {x, 1, 0.2f}, emitter);
        Environment sky;
        sky.width = 2;
        sky.height = 1;
        sky.radiance = {glm::vec3(0.5f), glm::vec3(1.5f)};
        maker.scene.environment = sky;
    }

    LightChoice choice() const {
        return packScene(maker.scene, buildWideBvh(maker.scene)).lights.choice;
    }

    SceneMaker maker;
};

/// The sky brings pi, the lights 0.04 times their emission over the squared half of the diagonal,
/// 0.75.
TEST(LightChoice, IsByPowerWhereAnEnvironmentOutshinesTheEmitters) {
    EXPECT_EQ(SceneUnderSky(2).choice(), LightChoice::Power);
    EXPECT_EQ(SceneUnderSky(6).choice(), LightChoice::Tree);
}

/// A light that bounces cannot find is not left to few samples.
TEST(LightChoice, IsByTreeWhereThereIsAPointLight) {
    SceneUnderSky scene(2);
    Light point;
    point.kind = LightKind::Point;
    point.color = glm::vec3(1e-6f);
    point.position = {0, 2, 0};
    scene.maker.scene.lights.push_back(point);
    EXPECT_EQ(scene.choice(), LightChoice::Tree);
}

/// A sample of the sky is dear, and where there is a lamp it is often in shadow.
TEST(LightChoice, OfTwoIsByTreeForASkyAndALampAlone) {
    SceneUnderSky scene(2);
    scene.maker.scene.triangles.pop_back();
    EXPECT_EQ(scene.choice(), LightChoice::Tree) << "faint beside the sky, but not left out";
    scene.maker.scene.triangles.pop_back();
    scene.maker.scene.lights.emplace_back().kind = LightKind::Point;
    EXPECT_EQ(scene.choice(), LightChoice::Each) << "a delta light";
    SceneUnderSky lamps(2);
    lamps.maker.scene.environment.reset();
    lamps.maker.sphere({0, 2, 0}, 0.1f, 1);
    lamps.maker.scene.triangles.resize(1);
    lamps.maker.sphere({0, 3, 0}, 0.1f, 1);
    EXPECT_EQ(lamps.choice(), LightChoice::Each) << "two lamps";
}

} // namespace
} // namespace stromboli::test
