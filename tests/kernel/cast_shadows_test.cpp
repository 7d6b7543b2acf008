// Shadow maps: what they say is in shadow would meet a surface, whatever rounding makes of rays,
// and each cell that a triangle shades as a whole is told.
#include "host/kernel/cast_shadows.hpp"

#include "host/bvh/cpu_traversal.hpp"
#include "host/kernel/certain_shadow.hpp"
#include "host/kernel/kernel_features.hpp"
#include "shaders/shared/bsdf_types.h"
#include "shaders/shared/medium_types.h"
#include "shaders/shared/render_types.h"
#include "tests/kernel/window_room.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <vector>

namespace stromboli {
namespace {

using namespace test;

Light sunTowards(const glm::vec3& towards, float brightness = 1) {
    Light sun;
    sun.kind = LightKind::Directional;
    sun.direction = -glm::normalize(towards);
    sun.color = glm::vec3(brightness);
    return sun;
}

/// The room with a sun that shines in by its window, and no sky; a long way from the origin
/// coordinates are rounded more.
Scene sunnyRoom(float window, const glm::vec3& way = glm::vec3(0)) {
    Scene scene = roomWithWindow(window);
    scene.environment.reset();
    scene.lights.push_back(sunTowards({-1, 0.4f, -0.2f}));
    for (glm::vec3& p : scene.positions)
        p += way;
    return scene;
}

Camera viewAt(const glm::vec3& way) {
    Camera view = kRoomView;
    view.position += way;
    return view;
}

float heightOf(const ShadowMap& map, size_t column, size_t row) {
    const size_t cell = row * gpu::SHADOW_MAP_SIDE + column;
    return std::bit_cast<float>(map.heights[cell / 4][cell % 4]);
}

/// Of many places all over the room none that is told to be in shadow is lit.
TEST(CastShadows, WhatIsInShadowMeetsAWall) {
    for (const float far : {0.0f, 300.0f}) {
        const glm::vec3 way(far, -far, far);
        const Scene scene = sunnyRoom(0.8f, way);
        const GpuScene g = packed(scene);
        const auto map = castShadows(scene, g, viewAt(way));
        ASSERT_TRUE(map);
        Random random(7);
        int told = 0, wrong = 0, blocked = 0;
        constexpr int kPlaces = 200'000;
        for (int i = 0; i < kPlaces; ++i) {
            const glm::vec3 from = way + random.inCube(0.999f);
            const bool isBlocked = anyHit(g.bvh, {.origin = from, .direction = map->towards});
            const bool isTold = isInShadow(*map, from, map->towards);
            told += isTold, blocked += isBlocked, wrong += isTold && !isBlocked;
        }
        EXPECT_EQ(wrong, 0) << "at " << far;
        EXPECT_GT(told, blocked / 2) << "at " << far;
        EXPECT_LT(blocked, kPlaces - kPlaces / 50) << "the sun shines in";
    }
}

/// Places that triangles of all sizes and directions shade or do not, one of which stands on edge.
TEST(CastShadows, NoneOfManyTrianglesShadesWhatIsLit) {
    Random random(19);
    scenes::SceneMaker b;
    const uint32_t white = b.add(scenes::diffuse(0.6f));
    b.quad({-2, -1, -2}, {0, 0, 4}, {4, 0, 0}, white);
    for (int i = 0; i < 200; ++i)
        b.triangle(random.inCube(1), random.inCube(1), random.inCube(1), white);
    const glm::vec3 towards = glm::normalize(glm::vec3(0.3f, 0.8f, 0.5f));
    for (int i = 0; i < 20; ++i) { // along the light, nearly
        const glm::vec3 p = random.inCube(1), q = random.inCube(1);
        b.triangle(p, p + towards + 0.01f * random.direction(), q, white);
    }
    b.scene.lights.push_back(sunTowards(towards));
    const GpuScene g = packed(b.scene);
    const auto map = castShadows(b.scene, g, lookingAt({0, 3, 4}, {0, -1, 0}, 0.8));
    ASSERT_TRUE(map);
    int told = 0, wrong = 0;
    for (int i = 0; i < 200'000; ++i) {
        const glm::vec3 from = random.inCube(1);
        const bool isTold = isInShadow(*map, from, map->towards);
        told += isTold;
        wrong += isTold && !anyHit(g.bvh, {.origin = from, .direction = map->towards});
    }
    EXPECT_EQ(wrong, 0);
    EXPECT_GT(told, 50'000);
}

/// A roof of four triangles, cell by cell against the definition: all corners of the cell, with
/// what rounding asks for, lie in one triangle.
TEST(CastShadows, TellsEachCellThatATriangleShades) {
    scenes::SceneMaker b;
    const uint32_t white = b.add(scenes::diffuse(0.6f));
    b.quad({-3, 0, -3}, {0, 0, 6}, {6, 0, 0}, white);
    const std::array<glm::vec3, 5> corner = {
        {{-1, 1, -1}, {1.1f, 1.3f, -0.8f}, {0.9f, 1, 1.2f}, {-1.2f, 0.8f, 0.9f}, {0.1f, 1.4f, 0}}};
    for (uint32_t i = 0; i < 4; ++i)
        b.triangle(corner[i], corner[(i + 1) % 4], corner[4], white);
    b.scene.lights.push_back(sunTowards({0.2f, 1, 0.1f}));
    const auto map = castShadows(b.scene, packed(b.scene), lookingAt({0, 6, 0.1}, {0, 0, 0}, 0.8));
    ASSERT_TRUE(map);
    const auto seen = [&](const glm::dvec3& p) {
        const auto at = [&](const glm::vec4& row) {
            return glm::dot(glm::dvec3(row), p) + double(row.w);
        };
        return glm::dvec3(at(map->across), at(map->along), glm::dot(glm::dvec3(map->towards), p));
    };
    // The floor is in the map, too: what is told well above it is told of the roof.
    const glm::dvec3 zero = seen({0, 0, 0}), one = seen({1, 0, 0}) - zero,
                     other = seen({0, 0, 1}) - zero;
    const auto floorAt = [&](double column, double row) {
        const glm::dvec2 p(column - zero.x, row - zero.y);
        const double area = one.x * other.y - one.y * other.x;
        const double ofOne = (p.x * other.y - p.y * other.x) / area,
                     ofOther = (one.x * p.y - one.y * p.x) / area;
        return zero.z + ofOne * one.z + ofOther * other.z;
    };
    const double around =
        0.5 + 2 * certainThickness(b.scene) * glm::length(glm::dvec3(map->across));
    size_t dark = 0, missed = 0, wrong = 0;
    for (size_t row = 0; row < gpu::SHADOW_MAP_SIDE; row += 3)
        for (size_t column = 0; column < gpu::SHADOW_MAP_SIDE; column += 3) {
            bool isShaded = false, isNearly = false;
            double height = 0;
            for (uint32_t i = 0; i < 4; ++i) {
                const glm::dvec3 v0 = seen(corner[i]), e1 = seen(corner[(i + 1) % 4]) - v0,
                                 e2 = seen(corner[4]) - v0;
                const double area = e1.x * e2.y - e1.y * e2.x;
                double least = 1, lowest = 1e9;
                for (const double x : {-around, around})
                    for (const double y : {-around, around}) {
                        const glm::dvec2 p(double(column) + 0.5 + x - v0.x,
                                           double(row) + 0.5 + y - v0.y);
                        const double b1 = (p.x * e2.y - p.y * e2.x) / area;
                        const double b2 = (e1.x * p.y - e1.y * p.x) / area;
                        least = std::min({least, b1, b2, 1 - b1 - b2});
                        lowest = std::min(lowest, v0.z + b1 * e1.z + b2 * e2.z);
                    }
                if (least > -1e-3) isNearly = true;
                if (least > 1e-3) isShaded = true, height = lowest;
            }
            const float told = heightOf(*map, column, row);
            const bool isTold =
                double(told) > floorAt(double(column) + 0.5, double(row) + 0.5) + 0.3;
            dark += isTold;
            missed += isShaded && !isTold, wrong += isTold && !isNearly;
            if (isShaded && isTold) {
                EXPECT_LT(double(told), height);
                EXPECT_GT(double(told), height - 1e-3);
            }
        }
    EXPECT_EQ(missed, 0u);
    EXPECT_EQ(wrong, 0u);
    EXPECT_GT(dark, 1000u);
}

/// From the points of a surface the sun is not taken to be behind that surface.
TEST(CastShadows, NothingIsInTheShadowOfItself) {
    scenes::SceneMaker b;
    const glm::vec3 edgeA(0, 0.7f, 10), edgeB(10, 0.3f, 0);
    b.quad({-5, 0, -5}, edgeA, edgeB, b.add(scenes::diffuse(0.5f)));
    for (const glm::vec3& towards : {glm::vec3(0.3f, 1, 0.2f), glm::vec3(1, 0.2f, 0.1f)}) {
        Scene scene = b.scene;
        scene.lights.push_back(sunTowards(towards));
        const auto map = castShadows(scene, packed(scene), lookingAt({0, 6, 1}, {0, 0, 0}, 0.8));
        ASSERT_TRUE(map);
        Random random(3);
        for (int i = 0; i < 10'000; ++i) {
            const glm::vec3 p = glm::vec3(-5, 0, -5) + random.uniform() * edgeA +
                                random.uniform() * edgeB + 0x1p-22f * random.direction();
            EXPECT_FALSE(isInShadow(*map, p, map->towards));
        }
    }
}

/// Leaves that are cut out and veils let light through, or may.
TEST(CastShadows, OnlyWhatIsOpaqueCounts) {
    const auto isThere = [](AlphaMode mode) {
        Scene scene = sunnyRoom(0.8f);
        for (Material& m : scene.materials)
            m.alphaMode = mode;
        return castShadows(scene, packed(scene), kRoomView, 0.01).has_value();
    };
    EXPECT_TRUE(isThere(AlphaMode::Opaque));
    EXPECT_FALSE(isThere(AlphaMode::Mask));
    EXPECT_FALSE(isThere(AlphaMode::Blend));
}

TEST(CastShadows, OfTheBrightestSun) {
    Scene scene = sunnyRoom(0.8f);
    scene.lights.push_back(sunTowards({-1, 0.1f, 0.4f}, 7));
    scene.lights.push_back(sunTowards({-1, 0.9f, 0}, 3));
    const auto map = castShadows(scene, packed(scene), kRoomView);
    ASSERT_TRUE(map);
    EXPECT_EQ(map->towards, -scene.lights[1].direction);
    EXPECT_FALSE(isInShadow(*map, {0.5f, 0, 0}, -scene.lights[0].direction)) << "of another";
}

/// Without a sun there is nothing to cast, media make light go on, glass bends it, and in the open
/// nothing is in shadow.
TEST(CastShadows, WhereThereIsNone) {
    const Scene scene = sunnyRoom(0.8f);
    GpuScene g = packed(scene);
    EXPECT_TRUE(shadowsThatPay(scene, g, kRoomView));
    const Scene dark = roomWithWindow(0.8f);
    EXPECT_FALSE(castShadows(dark, packed(dark), kRoomView));
    g.looksAtShadowMap = true;
    EXPECT_TRUE(looksAtShadowMap(g, {}));
    GpuScene glazed = packed(scene);
    glazed.looksAtShadowMap = true;
    glazed.closures.some |= gpu::LOBE_DELTA_TRANSMISSION;
    glazed.glassBeforeLights = 0.5;
    EXPECT_FALSE(looksAtShadowMap(glazed, {}));
    g.media = gpu::MEDIA_SCATTER;
    EXPECT_FALSE(castShadows(scene, g, kRoomView));
    scenes::SceneMaker open;
    open.quad({-5, 0, -5}, {0, 0, 10}, {10, 0, 0}, open.add(scenes::diffuse(0.5f)));
    open.scene.lights.push_back(sunTowards({0.3f, 1, 0.2f}));
    EXPECT_FALSE(
        shadowsThatPay(open.scene, packed(open.scene), lookingAt({0, 2, 4}, {0, 0, 0}, 0.8)));
}

} // namespace
} // namespace stromboli
