// Rays of the host through a scene: to the sky in the shortest way, with what the longest one
// finds.
#include "host/kernel/seen_places.hpp"

#include "host/core/random.hpp"
#include "tests/kernel/window_room.hpp"

#include <gtest/gtest.h>

#include <cstddef>

namespace stromboli {
namespace {

using namespace test;

/// Random rays from within the room; returns how many are free.
size_t expectSameWays(const Scene& scene, bool goThroughGlass) {
    constexpr int kRays = 4000;
    const GpuScene gpu = packed(scene);
    const SceneRays rays(scene, gpu, goThroughGlass);
    Random random(5);
    size_t free = 0;
    for (int i = 0; i < kRays; ++i) {
        TraversalRay ray;
        ray.origin = random.inCube(0.9f);
        ray.direction = random.direction();
        const Found found = rays.followToLight(ray);
        const WayToSky way = rays.followToSky(ray);
        EXPECT_EQ(way.isFree, !found.hit && found.keepsDirection(ray.direction)) << i;
        if (way.isFree) {
            EXPECT_EQ(way.panes, found.panes) << i;
        }
        free += way.isFree;
    }
    return free;
}

Scene roomWithVeil(AlphaMode mode) {
    scenes::SceneMaker b;
    b.scene = roomWithWindow(1.6f);
    Material veil = scenes::diffuse(0.5f);
    veil.alphaMode = mode;
    veil.opacity = 0.5f;
    b.quad({-0.95f, -1, -1}, {0, 2, 0}, {0, 0, 2}, b.add(veil));
    return b.scene;
}

TEST(SceneRays, FindTheSkyByAnyHitAsByTheClosest) {
    const size_t open = expectSameWays(roomWithWindow(1.6f), false);
    EXPECT_GT(open, 100u);
    EXPECT_LT(open, 3000u);
}

/// A ray that ended at the first hit of any would be stopped by the veil before the window.
TEST(SceneRays, GoThroughWhatMayBeNotThere) {
    EXPECT_EQ(expectSameWays(roomWithVeil(AlphaMode::Blend), false),
              expectSameWays(roomWithWindow(1.6f), false));
    EXPECT_EQ(expectSameWays(roomWithVeil(AlphaMode::Opaque), false), 0u);
}

/// Likewise by a pane.
TEST(SceneRays, GoThroughGlass) {
    scenes::SceneMaker b;
    b.scene = roomWithWindow(1.6f);
    Material pane;
    pane.kind = MaterialKind::ThinDielectric;
    b.quad({-0.95f, -1, -1}, {0, 2, 0}, {0, 0, 2}, b.add(pane));
    EXPECT_EQ(expectSameWays(b.scene, true), expectSameWays(roomWithWindow(1.6f), true));
    EXPECT_EQ(expectSameWays(b.scene, false), 0u);
}

} // namespace
} // namespace stromboli
