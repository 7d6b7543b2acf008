// Light samples that a shadow map stops without a ray: the same picture with fewer rays.
#include "host/kernel/cast_shadows.hpp"
#include "host/kernel/light_notes.hpp"
#include "tests/kernel/stopped_light.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace stromboli {
namespace {

using namespace test;

class LightInShadow : public StoppedLight {
  protected:
    Picture pictureOf(const Scene& loaded, bool looks, const KernelTuning& tuning = {}) {
        const auto castThem = [&](GpuScene& scene) {
            if (looks) scene.shadowMap = castShadows(loaded, scene, kRoomView);
            EXPECT_EQ(scene.shadowMap.has_value(), looks);
            scene.looksAtShadowMap = looks;
        };
        return StoppedLight::pictureOf(loaded, castThem, SPEC_SHADOW_MAP, looks, tuning);
    }

    static Scene withSun(Scene scene) {
        scene.lights.push_back(sun());
        scene.lights.back().color = glm::vec3(3);
        return scene;
    }
};

/// By the light of the sun alone, beside a sky, and beside lamps and another sun.
TEST_F(LightInShadow, IsThePictureWithFewerRays) {
    Scene alone = withSun(roomWithWindow(1));
    alone.environment.reset();
    Scene withLamps = withSun(roomWithMore(2));
    withLamps.lights.push_back(withLamps.lights.front());
    withLamps.lights.back().direction = glm::normalize(glm::vec3(1, -0.1f, -0.3f));
    const std::vector<Scene> scenes = {alone, withSun(roomWithWindow(1)), withLamps};
    for (size_t i = 0; i < scenes.size(); ++i)
        expectTheSameWithFewerRays(pictureOf(scenes[i], false), pictureOf(scenes[i], true),
                                   "scene " + std::to_string(i));
}

/// The map lies behind what guides light samples to the sky.
TEST_F(LightInShadow, IsThePictureBesideAGuide) {
    const Scene scene = withSun(roomWithWindow(1));
    const auto guided = [&](bool looks) {
        return StoppedLight::pictureOf(
            scene,
            [&](GpuScene& packed) {
                packed.guide = learnLightGuide(noteLightSamples(scene, packed, kRoomView, false),
                                               *packed.lights.environment);
                if (looks) packed.shadowMap = castShadows(scene, packed, kRoomView);
                packed.looksAtShadowMap = looks;
            },
            SPEC_SHADOW_MAP, looks, {});
    };
    settings_.estimator.guidesLight = true;
    expectTheSameWithFewerRays(guided(false), guided(true), "guided");
}

/// A camera that sees nothing has no map, and its kernel looks at none.
TEST_F(LightInShadow, IsThePictureWhereThereIsNoMap) {
    const Scene scene = withSun(roomWithWindow(1));
    const Picture without = StoppedLight::pictureOf(
        scene, [](GpuScene& packed) { packed.looksAtShadowMap = true; }, SPEC_SHADOW_MAP, true, {});
    EXPECT_TRUE(sameStatistics(pictureOf(scene, false).film, without.film));
}

TEST_F(LightInShadow, HasTheSameBytesHoweverTheWorkIsCut) {
    const Scene scene = withSun(roomWithMore(2));
    expectTheSameBytesHoweverTheWorkIsCut(
        [&](const KernelTuning& tuning) { return pictureOf(scene, true, tuning).film; });
}

} // namespace
} // namespace stromboli
