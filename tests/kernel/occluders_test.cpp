// Light samples that are stopped by occluders without a ray: the same picture with fewer rays.
#include "host/kernel/find_occluders.hpp"
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

class OccludedLight : public DeviceTest {
  protected:
    OccludedLight() {
        settings_.area.width = 48, settings_.area.height = 36;
        settings_.budget.mostSamplesPerPixel = 16;
        settings_.estimator.maxBounces = 3;
    }

    struct Picture {
        Film film;
        uint64_t rays = 0;
    };

    /// The walls of the room with a window of this side.
    Occluders wallsOf(float window) {
        const Scene room = roomWithWindow(window);
        Occluders walls = findOccluders(room, packed(room), kRoomView);
        EXPECT_GE(walls.all.size(), 4u);
        return walls;
    }

    GpuScene packed(const Scene& scene) {
        return packScene(scene, buildWideBvh(scene), lightSelection(settings_.estimator));
    }

    Picture pictureOf(const Scene& loaded, const Occluders& occluders,
                      const KernelTuning& tuning = {}) {
        GpuScene scene = packed(loaded);
        scene.occluders = occluders;
        scene.looksAtOccluders = !occluders.all.empty();
        VulkanBackend backend(testDevice(), scene, kRoomView, settings_, tuning);
        EXPECT_EQ(backend.features()[SPEC_OCCLUDERS] != 0, !occluders.all.empty());
        Picture picture;
        picture.film = render(backend, settings_);
        picture.rays = backend.counters().rays;
        return picture;
    }

    RenderSettings settings_;
};

/// A room without a sky.
Scene dark(float window) {
    Scene scene = roomWithWindow(window);
    scene.environment.reset();
    return scene;
}

/// By the light of a sky, of a sky and lamps in the room, of the sun, of a lamp outside of the
/// room, and of a point light there.
TEST_F(OccludedLight, IsThePictureWithFewerRays) {
    constexpr float kWindow = 1; // of roomWithMore()
    std::vector<Scene> scenes = {roomWithWindow(kWindow), roomWithMore(2), dark(kWindow),
                                 dark(kWindow), dark(kWindow)};
    Light sun;
    sun.kind = LightKind::Directional;
    sun.direction = glm::normalize(glm::vec3(1, -0.4f, 0.2f));
    scenes[2].lights.push_back(sun);
    scenes::SceneMaker withLamp;
    withLamp.scene = scenes[3];
    withLamp.quad({-3, -1, -1}, {0, 2, 0}, {0, 0, 2}, withLamp.add(scenes::emissive(30)));
    scenes[3] = withLamp.scene;
    Light point;
    point.position = {-2, 0.3f, 0.1f};
    scenes[4].lights.push_back(point);
    const Occluders walls = wallsOf(kWindow);
    for (size_t i = 0; i < scenes.size(); ++i) {
        const Picture plain = pictureOf(scenes[i], {}), with = pictureOf(scenes[i], walls);
        EXPECT_TRUE(sameStatistics(plain.film, with.film)) << "scene " << i;
        EXPECT_LT(with.rays, plain.rays - plain.rays / 50) << "scene " << i;
    }
}

TEST_F(OccludedLight, HasTheSameBytesHoweverTheWorkIsCut) {
    const Scene scene = roomWithMore(2);
    const Occluders walls = wallsOf(1);
    expectTheSameBytesHoweverTheWorkIsCut(
        [&](const KernelTuning& tuning) { return pictureOf(scene, walls, tuning).film; });
}

} // namespace
} // namespace stromboli
