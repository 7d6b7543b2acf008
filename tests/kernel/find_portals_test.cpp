// Portals that are found: windows of rooms and nothing else, and those that are stated.
#include "host/kernel/find_portals.hpp"

#include "tests/kernel/window_room.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace stromboli {
namespace {

using namespace test;

Portals foundIn(const Scene& scene, const Camera& camera = kRoomView) {
    return findPortals(buildWideBvh(scene), camera, 1);
}

/// The portal's box has these corners, to within a share of its longest side; it may lie in a
/// recess behind the first coordinate of both.
void expectBox(const Portal& p, const glm::vec3& lo, const glm::vec3& hi, float share = 0.06f) {
    const glm::vec3 end = p.corner + p.edgeA + p.edgeB, a = glm::min(p.corner, end),
                    b = glm::max(p.corner, end);
    const float side = std::max(glm::length(p.edgeA), glm::length(p.edgeB));
    for (int k = 0; k < 3; ++k) {
        EXPECT_NEAR(a[k], lo[k], share * side) << "axis " << k;
        EXPECT_NEAR(b[k], hi[k], share * side) << "axis " << k;
    }
}

TEST(FindPortals, FindsTheWindowOfARoom) {
    const Portals found = foundIn(roomWithWindow(0.8f));
    ASSERT_EQ(found.all.size(), 1u);
    const Portal& p = found.all.front();
    expectBox(p, {-1, -0.4f, -0.4f}, {-1, 0.4f, 0.4f});
    EXPECT_GT(glm::cross(p.edgeA, p.edgeB).x, 0) << "points into the room";
    EXPECT_NEAR(glm::dot(p.edgeA, p.edgeB), 0, 1e-5f);
    EXPECT_GE(found.share, 0.5);
    EXPECT_LE(found.share, 0.75);
}

/// The more uneven the sky, the less aiming gains. The search ends early where it can gain nothing:
/// it must not where it gains, which this room's window does up to 32, also if the search is never
/// ended.
TEST(FindPortals, FindsTheSameUnlessAnUnevenSkyTakesTheGain) {
    const WideLayout bvh = buildWideBvh(roomWithWindow(0.4f));
    const Portals even = findPortals(bvh, kRoomView, 1);
    ASSERT_EQ(even.all.size(), 1u);
    for (double unevenness = 2; unevenness <= 1024; unevenness *= 2) {
        SCOPED_TRACE(unevenness);
        const Portals found = findPortals(bvh, kRoomView, unevenness);
        ASSERT_EQ(found.all.size(), unevenness <= 32 ? 1u : 0u);
        if (!found.all.empty()) {
            EXPECT_EQ(found.all[0].corner, even.all[0].corner);
            EXPECT_EQ(found.all[0].edgeA, even.all[0].edgeA);
            EXPECT_EQ(found.all[0].edgeB, even.all[0].edgeB);
        }
    }
}

/// As the wall of the window, but another one.
TEST(FindPortals, FindsEachOfTwoWindows) {
    scenes::SceneMaker b;
    b.scene = roomWithWindow(0.5f);
    // The wall z = -1 again, with a window from -0.8 to -0.2 and from -0.5 to 0.5.
    auto& triangles = b.scene.triangles;
    std::erase_if(triangles, [&](const Triangle& t) {
        return std::ranges::all_of(t.corner,
                                   [&](uint32_t c) { return b.scene.positions[c].z == -1; });
    });
    const uint32_t white = b.scene.triangles.front().material;
    b.quad({-1, -1, -1}, {2, 0, 0}, {0, 0.5f, 0}, white);
    b.quad({-1, 0.5f, -1}, {2, 0, 0}, {0, 0.5f, 0}, white);
    b.quad({-1, -0.5f, -1}, {0.2f, 0, 0}, {0, 1, 0}, white);
    b.quad({-0.2f, -0.5f, -1}, {1.2f, 0, 0}, {0, 1, 0}, white);
    Portals found = foundIn(b.scene);
    ASSERT_EQ(found.all.size(), 2u);
    std::ranges::sort(found.all, {}, [](const Portal& p) { return p.corner.z; });
    expectBox(found.all[0], {-0.8f, -0.5f, -1}, {-0.2f, 0.5f, -1});
    expectBox(found.all[1], {-1, -0.25f, -0.25f}, {-1, 0.25f, 0.25f});
}

/// A post stands in the middle of the window: one rectangle around both would aim at the post, too.
TEST(FindPortals, TellsWindowsOfOneWallApart) {
    scenes::SceneMaker b;
    b.scene = roomWithWindow(1);
    b.quad({-1, -0.5f, -0.15f}, {0, 1, 0}, {0, 0, 0.3f}, b.scene.triangles.front().material);
    Portals found = foundIn(b.scene);
    ASSERT_EQ(found.all.size(), 2u);
    std::ranges::sort(found.all, {}, [](const Portal& p) { return p.corner.z + p.edgeA.z; });
    expectBox(found.all[0], {-1, -0.5f, -0.5f}, {-1, 0.5f, -0.15f});
    expectBox(found.all[1], {-1, -0.5f, 0.15f}, {-1, 0.5f, 0.5f});
}

TEST(FindPortals, FindsNothingInTheOpenInTheDarkAndOfNothing) {
    scenes::SceneMaker open;
    open.quad({-5, -1, -5}, {0, 0, 10}, {10, 0, 0}, open.add(scenes::diffuse(0.6f)));
    EXPECT_TRUE(foundIn(open.scene).all.empty());
    scenes::SceneMaker closed;
    closed.scene = roomWithWindow(0.5f);
    closed.quad({-1, -0.5f, -0.5f}, {0, 1, 0}, {0, 0, 1}, 0);
    EXPECT_TRUE(foundIn(closed.scene).all.empty());
    const Camera away = lookingAt({50, 0, 0}, {60, 0, 0}, 0.8);
    EXPECT_TRUE(foundIn(roomWithWindow(0.5f), away).all.empty()) << "the camera sees nothing";
}

/// Samples that aim at a window miss a sun in the sky's picture.
TEST(FindPortals, FindsNothingUnderASunThatIsSmallerThanTheWindow) {
    const WideLayout bvh = buildWideBvh(roomWithWindow(0.8f));
    EXPECT_EQ(findPortals(bvh, kRoomView, 2).all.size(), 1u);
    EXPECT_TRUE(findPortals(bvh, kRoomView, 100).all.empty());
}

/// Bytes of pictures depend on it.
TEST(FindPortals, FindsTheSameAgain) {
    const Scene scene = roomWithWindow(0.8f);
    const Portals a = foundIn(scene), b = foundIn(scene);
    ASSERT_EQ(a.all.size(), b.all.size());
    EXPECT_EQ(a.share, b.share);
    for (size_t i = 0; i < a.all.size(); ++i) {
        EXPECT_EQ(a.all[i].corner, b.all[i].corner);
        EXPECT_EQ(a.all[i].edgeA, b.all[i].edgeA);
        EXPECT_EQ(a.all[i].edgeB, b.all[i].edgeB);
    }
}

TEST(StatedPortals, FaceTheCameraAndAreNotTooMany) {
    const Portal towardsX = {{-1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                 awayFromX = {{-1, 0, 0}, {0, 0, 1}, {0, 1, 0}};
    const std::vector<Portal> both = {towardsX, awayFromX};
    for (const Portal& p : statedPortals(both, kRoomView).all)
        EXPECT_GT(glm::cross(p.edgeA, p.edgeB).x, 0);
    const std::vector<Portal> many(kMostPortals + 3, towardsX);
    EXPECT_EQ(statedPortals(many, kRoomView).all.size(), kMostPortals);
}

} // namespace
} // namespace stromboli
