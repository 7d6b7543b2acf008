// Light samples that a shadow map stops without a ray: the same picture with fewer rays.
#include "host/kernel/cast_shadows.hpp"
#include "host/kernel/light_table.hpp"
#include "host/render/sampling_session.hpp"
#include "tests/kernel/window_room.hpp"
#include "tests/render/device_render.hpp"
#include "tests/support/device_fixture.hpp"

#include <gtest/gtest.h>

#include <cstdint>

namespace stromboli {
namespace {

using namespace test;

class LightInShadow : public DeviceTest {
  protected:
    LightInShadow() {
        settings_.area.width = 48, settings_.area.height = 36;
        settings_.budget.mostSamplesPerPixel = 16;
        settings_.estimator.maxBounces = 3;
    }

    struct Picture {
        Film film;
        uint64_t rays = 0;
    };

    Picture pictureOf(const Scene& loaded, bool looks, const KernelTuning& tuning = {}) {
        GpuScene scene =
            packScene(loaded, buildWideBvh(loaded), lightSelection(settings_.estimator));
        if (looks) scene.shadowMap = castShadows(loaded, scene, kRoomView);
        EXPECT_EQ(scene.shadowMap.has_value(), looks);
        scene.looksAtShadowMap = looks;
        VulkanBackend backend(testDevice(), scene, kRoomView, settings_, tuning);
        EXPECT_EQ(backend.features()[SPEC_SHADOW_MAP] != 0, looks);
        Picture picture;
        picture.film = render(backend, settings_);
        picture.rays = backend.counters().rays;
        return picture;
    }

    static Scene withSun(Scene scene) {
        Light sun;
        sun.kind = LightKind::Directional;
        sun.direction = glm::normalize(glm::vec3(1, -0.4f, 0.2f));
        sun.color = glm::vec3(3);
        scene.lights.push_back(sun);
        return scene;
    }

    RenderSettings settings_;
};

/// By the light of the sun alone, beside a sky, beside a sky that light samples are guided to or
/// aim at by a portal in the same buffer, and beside lamps and another sun.
TEST_F(LightInShadow, IsThePictureWithFewerRays) {
    Scene alone = withSun(roomWithWindow(1));
    alone.environment.reset();
    Scene withLamps = withSun(roomWithMore(2));
    withLamps.lights.push_back(withLamps.lights.front());
    withLamps.lights.back().direction = glm::normalize(glm::vec3(1, -0.1f, -0.3f));
    const std::vector<Scene> scenes = {alone, withSun(roomWithWindow(1)), withLamps};
    for (size_t i = 0; i < scenes.size(); ++i) {
        const Picture plain = pictureOf(scenes[i], false), with = pictureOf(scenes[i], true);
        EXPECT_TRUE(sameStatistics(plain.film, with.film)) << "scene " << i;
        EXPECT_LT(with.rays, plain.rays - plain.rays / 50) << "scene " << i;
    }
}

/// A camera that sees nothing has no map, and looks at none.
TEST_F(LightInShadow, IsThePictureWhereThereIsNoMap) {
    const Scene scene = withSun(roomWithWindow(1));
    GpuScene packed = packScene(scene, buildWideBvh(scene), lightSelection(settings_.estimator));
    packed.looksAtShadowMap = true;
    VulkanBackend backend(testDevice(), packed, kRoomView, settings_, {});
    EXPECT_NE(backend.features()[SPEC_SHADOW_MAP], 0u);
    EXPECT_TRUE(sameStatistics(pictureOf(scene, false).film, render(backend, settings_)));
}

TEST_F(LightInShadow, HasTheSameBytesHoweverTheWorkIsCut) {
    const Scene scene = withSun(roomWithMore(2));
    expectTheSameBytesHoweverTheWorkIsCut(
        [&](const KernelTuning& tuning) { return pictureOf(scene, true, tuning).film; });
}

} // namespace
} // namespace stromboli
