// Occluders that are found: rectangles within walls, which nothing crosses that would not meet a
// wall, and what of a plane triangles cover.
#include "host/kernel/find_occluders.hpp"

#include "host/bvh/cpu_traversal.hpp"
#include "host/kernel/kernel_features.hpp"
#include "host/kernel/occluded_area.hpp"
#include "shaders/shared/bsdf_types.h"
#include "shaders/shared/medium_types.h"
#include "tests/kernel/window_room.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace stromboli {
namespace {

using namespace test;

// --- What of a plane is covered ------------------------------------------------------------------

/// Two triangles, cut along a diagonal.
void addRectangle(std::vector<FlatTriangle>& triangles, const glm::dvec2& lo,
                  const glm::dvec2& hi) {
    triangles.push_back({{lo, {hi.x, lo.y}, hi}});
    triangles.push_back({{lo, hi, {lo.x, hi.y}}});
}

TEST(OccludedArea, IsCoveredByTrianglesTogether) {
    std::vector<FlatTriangle> triangles;
    for (int i = 0; i < 5; ++i)
        for (int k = 0; k < 5; ++k)
            addRectangle(triangles, {0.2 * i, 0.2 * k}, {0.2 * (i + 1), 0.2 * (k + 1)});
    EXPECT_TRUE(isCovered({0, 0}, {1, 1}, triangles));
    EXPECT_TRUE(isCovered({0.07, 0.13}, {0.91, 0.58}, triangles));
    EXPECT_FALSE(isCovered({0.07, 0.13}, {1.01, 0.58}, triangles));
    triangles.erase(triangles.begin() + 17);
    EXPECT_FALSE(isCovered({0, 0}, {1, 1}, triangles)) << "one is missing";
}

/// As the two sides of a thin board, of which together there is as much as the rectangle has.
TEST(OccludedArea, IsNotCoveredByHalfOfItTwice) {
    std::vector<FlatTriangle> triangles;
    addRectangle(triangles, {0, 0}, {0.5, 1});
    addRectangle(triangles, {0, 0}, {0.5, 1});
    std::swap(triangles[2].corners[1], triangles[2].corners[2]); // seen from behind
    EXPECT_FALSE(isCovered({0, 0}, {1, 1}, triangles));
    EXPECT_TRUE(isCovered({0, 0}, {0.5, 1}, triangles));
}

/// Against all rectangles of a grid with holes, one by one.
TEST(OccludedArea, BestRectangleHoldsMost) {
    Random random(5);
    std::vector<FlatTriangle> triangles;
    for (int i = 0; i < 8; ++i)
        for (int k = 0; k < 8; ++k)
            if (random.uniform() < 0.85f)
                addRectangle(triangles, {i / 8.0, k / 8.0}, {(i + 1) / 8.0, (k + 1) / 8.0});
    std::vector<glm::dvec2> wanted;
    for (int i = 0; i < 4000; ++i)
        wanted.push_back({random.uniform(), random.uniform()});
    const OpaqueCells cells(triangles, wanted);
    std::vector<uint32_t> counts(kOpaqueSide * kOpaqueSide, 0);
    std::vector<bool> isOpaque(counts.size(), false);
    for (const glm::dvec2& w : wanted)
        if (const auto cell = cells.cellAt(w)) ++counts[*cell];
    for (size_t y = 0; y < kOpaqueSide; ++y)
        for (size_t x = 0; x < kOpaqueSide; ++x) {
            const glm::dvec2 middle = 0.5 * (cells.cornerOf(x, y) + cells.cornerOf(x + 1, y + 1));
            isOpaque[y * kOpaqueSide + x] = cells.cellAt(middle).has_value();
        }
    uint32_t most = 0;
    for (size_t y0 = 0; y0 < kOpaqueSide; ++y0)
        for (size_t y1 = y0; y1 < kOpaqueSide; ++y1)
            for (size_t x0 = 0; x0 < kOpaqueSide; ++x0) {
                uint32_t sum = 0;
                for (size_t x = x0; x < kOpaqueSide; ++x) {
                    bool isWhole = true;
                    for (size_t y = y0; y <= y1; ++y) {
                        isWhole &= bool(isOpaque[y * kOpaqueSide + x]);
                        sum += counts[y * kOpaqueSide + x];
                    }
                    if (!isWhole) break;
                    most = std::max(most, sum);
                }
            }
    const CellRectangle best = cells.bestRectangle(counts);
    EXPECT_EQ(best.count, most);
    for (size_t cell = 0; cell < counts.size(); ++cell)
        EXPECT_TRUE(!best.holds(cell) || isOpaque[cell]);
}

/// A turned board of long triangles: most length have its sides.
TEST(OccludedArea, AxesFollowTheEdges) {
    const double turn = 0.3;
    const auto at = [&](double x, double y) {
        return glm::dvec3(x * std::cos(turn) - y * std::sin(turn), 2,
                          x * std::sin(turn) + y * std::cos(turn));
    };
    std::vector<std::array<glm::dvec3, 3>> triangles;
    for (int i = 0; i < 6; ++i) {
        triangles.push_back({at(0, i), at(4, i), at(4, i + 1)});
        triangles.push_back({at(0, i), at(4, i + 1), at(0, i + 1)});
    }
    const glm::dvec3 edge = usualEdge({0, 1, 0}, triangles);
    const double ahead = std::abs(glm::dot(edge, at(1, 0) - at(0, 0)));
    EXPECT_NEAR(glm::length(edge), 1, 1e-12);
    EXPECT_LT(std::min(ahead, std::sqrt(1 - ahead * ahead)), 1e-6);
}

// --- Occluders -----------------------------------------------------------------------------------

/// A long way from the origin, where coordinates are rounded more.
Scene movedBy(Scene scene, const glm::vec3& way) {
    for (glm::vec3& p : scene.positions)
        p += way;
    return scene;
}

/// Whether the kernel takes a ray as stopped (shaders/include/occluders.glsl), in its floats.
bool isStopped(const Occluders& occluders, const glm::vec3& origin, const glm::vec3& direction) {
    const auto rows = occluderRows(occluders);
    const float least = leastFall(occluders) * glm::dot(direction, direction);
    bool stopped = false;
    for (size_t i = 0; i < occluders.all.size(); ++i) {
        const auto at = [](const glm::vec4& row, const glm::vec3& p) {
            return glm::dot(glm::vec3(row), p) + row.w;
        };
        const glm::vec4* row = &rows[gpu::OCCLUDER_ROWS * i];
        const float height = at(row[0], origin), fall = glm::dot(glm::vec3(row[0]), direction);
        const glm::vec3 p = origin - (height / fall) * direction;
        const float aside = std::max(std::abs(at(row[1], p)), std::abs(at(row[2], p)));
        stopped |= height * fall < 0 && std::abs(height) > 1 && fall * fall > least && aside < 1;
    }
    return stopped;
}

/// In rooms about the origin and far from it, of many rays that start in them all over the place
/// none that is taken as stopped is free; and through the window nothing is stopped.
TEST(FindOccluders, WhatTheyStopMeetsAWall) {
    for (const float far : {0.0f, 300.0f}) {
        const glm::vec3 way(far, -far, far);
        const Scene scene = movedBy(roomWithWindow(0.8f), way);
        Camera view = kRoomView;
        view.position += way;
        const GpuScene g = packed(scene);
        const Occluders found = findOccluders(scene, g, view);
        ASSERT_GE(found.all.size(), 4u) << "walls of the room";
        Random random(7);
        int stopped = 0, wrong = 0, blocked = 0;
        constexpr int kRays = 200'000;
        for (int i = 0; i < kRays; ++i) {
            const glm::vec3 from = way + random.inCube(0.999f), d = random.direction();
            const bool isBlocked = anyHit(g.bvh, {.origin = from, .direction = d});
            const bool isTaken = isStopped(found, from, d);
            stopped += isTaken, blocked += isBlocked, wrong += isTaken && !isBlocked;
        }
        EXPECT_EQ(wrong, 0) << "at " << far;
        EXPECT_GT(stopped, blocked / 2) << "at " << far;
    }
}

/// From the points of a wall nothing crosses that wall, whatever rounding makes of them.
TEST(FindOccluders, NothingLeavesAWallThroughItself) {
    const Scene scene = roomWithWindow(0.8f);
    Occluders found = findOccluders(scene, packed(scene), kRoomView);
    ASSERT_FALSE(found.all.empty());
    Random random(3);
    for (const Occluder& o : found.all) {
        Occluders alone = found;
        alone.all = {o};
        for (int i = 0; i < 1000; ++i) {
            const glm::dvec3 at = o.middle + double(random.uniform(-1, 1)) * o.halfAcross +
                                  double(random.uniform(-1, 1)) * o.halfAlong;
            const glm::vec3 from = glm::vec3(at) + 0x1p-22f * random.direction();
            EXPECT_FALSE(isStopped(alone, from, random.direction()));
        }
    }
}

/// Leaves that are cut out and veils let light through, or may.
TEST(FindOccluders, OnlyWhatIsOpaqueCounts) {
    const auto with = [](const auto& change) {
        Scene scene = roomWithWindow(0.8f);
        for (Material& m : scene.materials)
            change(m);
        return findOccluders(scene, packed(scene), kRoomView).all.size();
    };
    EXPECT_GT(with([](Material&) {}), 0u);
    EXPECT_EQ(with([](Material& m) { m.alphaMode = AlphaMode::Mask; }), 0u);
    EXPECT_EQ(with([](Material& m) { m.alphaMode = AlphaMode::Blend; }), 0u);
}

/// Instances may move what a plane holds, media make light go on, and glass bends it.
TEST(FindOccluders, NoneBesideInstancesMediaOrLightThroughGlass) {
    const Scene scene = roomWithWindow(0.8f);
    const GpuScene plain = packed(scene);
    ASSERT_FALSE(findOccluders(scene, plain, kRoomView).all.empty());
    GpuScene placed = packed(scene), misty = packed(scene), glazed = packed(scene);
    placed.hasPlacements = true;
    EXPECT_TRUE(findOccluders(scene, placed, kRoomView).all.empty());
    misty.media = gpu::MEDIA_SCATTER;
    EXPECT_TRUE(findOccluders(scene, misty, kRoomView).all.empty());
    glazed.looksAtOccluders = true;
    EXPECT_EQ(occludersLookedAt(glazed, {}), gpu::MOST_OCCLUDERS);
    glazed.closures.some |= gpu::LOBE_DELTA_TRANSMISSION;
    glazed.glassBeforeLights = 0.5;
    EXPECT_EQ(occludersLookedAt(glazed, {}), 0u);
}

/// An open floor stops no light of the sky above it that falls on it.
TEST(FindOccluders, NoneInTheOpen) {
    scenes::SceneMaker b;
    b.quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}, b.add(scenes::diffuse(0.5f)));
    b.scene.environment = roughSky();
    EXPECT_TRUE(
        findOccluders(b.scene, packed(b.scene), lookingAt({0, 2, 4}, {0, 0, 0}, 0.8)).all.empty());
}

} // namespace
} // namespace stromboli
