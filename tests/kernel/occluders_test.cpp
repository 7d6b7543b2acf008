// Light samples that are stopped by occluders without a ray: the same picture with fewer rays.
#include "host/kernel/find_occluders.hpp"
#include "tests/kernel/stopped_light.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace stromboli {
namespace {

using namespace test;

class OccludedLight : public StoppedLight {
  protected:
    /// The walls of the room with a window of this side.
    Occluders wallsOf(float window) {
        const Scene room = roomWithWindow(window);
        Occluders walls = findOccluders(room, packed(room), kRoomView);
        EXPECT_GE(walls.all.size(), 4u);
        return walls;
    }

    Picture pictureOf(const Scene& loaded, const Occluders& occluders,
                      const KernelTuning& tuning = {}) {
        const bool looks = !occluders.all.empty();
        const auto putThem = [&](GpuScene& scene) {
            scene.occluders = occluders;
            scene.looksAtOccluders = looks;
        };
        return StoppedLight::pictureOf(loaded, putThem, SPEC_OCCLUDERS, looks, tuning);
    }
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
    scenes[2].lights.push_back(sun());
    scenes::SceneMaker withLamp;
    withLamp.scene = scenes[3];
    withLamp.quad({-3, -1, -1}, {0, 2, 0}, {0, 0, 2}, withLamp.add(scenes::emissive(30)));
    scenes[3] = withLamp.scene;
    Light point;
    point.position = {-2, 0.3f, 0.1f};
    scenes[4].lights.push_back(point);
    const Occluders walls = wallsOf(kWindow);
    for (size_t i = 0; i < scenes.size(); ++i)
        expectTheSameWithFewerRays(pictureOf(scenes[i], {}), pictureOf(scenes[i], walls),
                                   "scene " + std::to_string(i));
}

TEST_F(OccludedLight, HasTheSameBytesHoweverTheWorkIsCut) {
    const Scene scene = roomWithMore(2);
    const Occluders walls = wallsOf(1);
    expectTheSameBytesHoweverTheWorkIsCut(
        [&](const KernelTuning& tuning) { return pictureOf(scene, walls, tuning).film; });
}

} // namespace
} // namespace stromboli
