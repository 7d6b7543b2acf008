// Scenes in the coordinates of a country, or under a node far away: nothing of their shape is lost.

#include "scene/build/scene_builder.hpp"

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace stromboli::build {
namespace {

using testing::Contains;
using testing::HasSubstr;

const FilePlace kPlace{"town.xyz", 7, "mesh"};
constexpr int kSteps = 100;
const glm::dvec3 kFar{4567890.25, 123.5, 5432100.75}; // where floats are half a metre apart

/// A stair of steps of 5 cm, each a square of two triangles, its first corner at `from`.
Mesh stair(const glm::dvec3& from) {
    Mesh mesh;
    mesh.parts.emplace_back();
    for (int i = 0; i < kSteps; ++i) {
        const auto first = uint32_t(mesh.positions.size());
        for (const glm::dvec3& p : {glm::dvec3(0, 0, 0), glm::dvec3(1, 0, 0),
                                    glm::dvec3(1, 0, 0.05), glm::dvec3(0, 0, 0.05)})
            mesh.positions.push_back(from + p + glm::dvec3(0, 0.05 * i, 0.05 * i));
        for (const std::array<uint32_t, 3>& t : {std::array<uint32_t, 3>{0, 1, 2}, {0, 2, 3}})
            mesh.parts[0].push_back({Corner{first + t[0], kNoNormals},
                                     Corner{first + t[1], kNoNormals},
                                     Corner{first + t[2], kNoNormals}});
    }
    return mesh;
}

glm::dmat4 movedTo(const glm::dvec3& p) {
    return glm::translate(glm::dmat4(1), p);
}

Scene placed(const Mesh& mesh, const std::vector<glm::dmat4>& toWorld,
             const SceneConventions& conventions = {}) {
    SceneBuilder builder("town.xyz", conventions);
    const std::vector<uint32_t> materials{builder.defaultMaterial()};
    const ShapeId shape = builder.addMesh("stair", mesh);
    for (const glm::dmat4& m : toWorld)
        builder.place(kPlace, shape, m, materials, "instance");
    return builder.finish();
}

/// Largest error of all vertices, in the file's coordinates.
double largestError(const Scene& scene, const Mesh& mesh, const glm::dvec3& moved) {
    double largest = 0;
    EXPECT_EQ(scene.positions.size(), mesh.positions.size());
    for (size_t i = 0; i < scene.positions.size(); ++i)
        largest = std::max(largest, glm::distance(glm::dvec3(scene.positions[i]) + scene.origin,
                                                  mesh.positions[i] + moved));
    return largest;
}

/// Positions are floats of up to ten metres: each component is off by 2^-21 m at most.
constexpr double kRounding = 0x1p-20;

TEST(FarScenes, OfFarCoordinatesKeepTheirSteps) {
    const Mesh mesh = stair(kFar);
    const Scene scene = placed(mesh, {glm::dmat4(1)});
    EXPECT_EQ(scene.triangles.size(), 2u * kSteps);
    EXPECT_LT(largestError(scene, mesh, {}), kRounding);
    EXPECT_THAT(scene.report.assumed, Contains(HasSubstr("far from the origin")));
}

TEST(FarScenes, UnderAFarNodeKeepTheirSteps) {
    const Mesh mesh = stair({});
    EXPECT_LT(largestError(placed(mesh, {movedTo(kFar)}), mesh, kFar), kRounding);
}

TEST(FarScenes, BackFromFarAwayAreAtTheirPlace) {
    // The mesh is far from its own origin, and its node brings it back.
    const Mesh mesh = stair(kFar);
    const Scene scene = placed(mesh, {movedTo(-kFar)});
    EXPECT_EQ(scene.origin, glm::dvec3(0));
    EXPECT_LT(largestError(scene, mesh, -kFar), kRounding);
}

TEST(FarScenes, LightsCamerasPortalsAndSpheresGoWithThem) {
    SceneBuilder builder("town.xyz", {});
    const std::vector<uint32_t> materials{builder.defaultMaterial()};
    builder.place(kPlace, builder.addMesh("stair", stair(kFar)), glm::dmat4(1), materials, "stair");
    const glm::dvec3 ball = kFar + glm::dvec3(1, 2, 3), lamp = kFar + glm::dvec3(0.1, 4, 0),
                     eye = kFar + glm::dvec3(0.3, 2, 9);
    builder.place(kPlace, builder.addSphere("ball", 0.5), movedTo(ball), materials, "ball");
    Light light;
    light.kind = LightKind::Point;
    light.color = glm::vec3(1);
    builder.placeLight(light, movedTo(lamp));
    builder.placeCamera({}, movedTo(eye));
    builder.addPortal(lamp, {1, 0, 0}, {0, 1, 0});
    const Scene scene = builder.finish();
    EXPECT_NE(scene.origin, glm::dvec3(0));
    EXPECT_LT(glm::distance(glm::dvec3(scene.portals.at(0).corner) + scene.origin, lamp),
              kRounding);
    EXPECT_LT(glm::distance(glm::dvec3(scene.spheres.at(0).center) + scene.origin, ball),
              kRounding);
    EXPECT_LT(glm::distance(glm::dvec3(scene.lights.at(0).position) + scene.origin, lamp),
              kRounding);
    EXPECT_LT(glm::distance(scene.cameras.at(0).position + scene.origin, eye), 1e-8);
    EXPECT_LT(
        glm::distance(scene.cameras.at(0).pointAhead + scene.origin, eye - glm::dvec3(0, 0, 1)),
        1e-8);
}

/// The scene of a stair at `from` with one light.
Scene litStair(const glm::dvec3& from, LightKind kind, const glm::dmat4& toWorld) {
    SceneConventions conventions;
    conventions.areaLights = AreaLights::StayLights; // else finish() makes triangles of them
    SceneBuilder builder("town.xyz", conventions);
    const std::vector<uint32_t> materials{builder.defaultMaterial()};
    builder.place(kPlace, builder.addMesh("stair", stair({})), movedTo(from), materials, "stair");
    Light light;
    light.kind = kind;
    light.color = glm::vec3(1);
    builder.placeLight(light, toWorld);
    return builder.finish();
}

TEST(FarScenes, OfALightOnlyThePlaceGoesWithThem) {
    // It shines along -z, and is turned about y.
    const glm::dmat4 turned = glm::rotate(glm::dmat4(1), 0.5, glm::dvec3(0, 1, 0));
    const glm::dvec3 aim(-std::sin(0.5), 0, -std::cos(0.5)), lamp = kFar + glm::dvec3(0.1, 4, 0);
    for (const LightKind kind : {LightKind::Directional, LightKind::Spot, LightKind::Area}) {
        const Scene scene = litStair(kFar, kind, movedTo(lamp) * turned);
        ASSERT_NE(scene.origin, glm::dvec3(0));
        const Light& light = scene.lights.at(0);
        EXPECT_LT(glm::distance(glm::dvec3(light.direction), aim), 0x1p-22); // rounded to floats
        if (kind != LightKind::Directional) {
            EXPECT_LT(glm::distance(glm::dvec3(light.position) + scene.origin, lamp), kRounding);
        }
        if (kind == LightKind::Area) {
            EXPECT_NEAR(glm::length(glm::cross(light.edgeX, light.edgeY)), 1, 0x1p-22);
        }
    }
}

TEST(FarScenes, LightsDoNotMoveTheOrigin) {
    const Scene scene = litStair({}, LightKind::Point, movedTo(kFar));
    EXPECT_EQ(scene.origin, glm::dvec3(0));
    EXPECT_EQ(scene.lights.at(0).position, glm::vec3(kFar));
}

TEST(FarScenes, InstancesShareTheirTriangles) {
    const Mesh mesh = stair(kFar); // of a prototype far from its own origin
    SceneConventions conventions;
    conventions.instances = InstanceSharing::On;
    const Scene scene = placed(mesh, {glm::dmat4(1), movedTo({3, 0, 0})}, conventions);
    ASSERT_EQ(scene.placements.size(), 2u);
    for (int i = 0; i < 2; ++i)
        for (size_t v = 0; v < scene.positions.size(); ++v) {
            glm::dvec3 p = scene.origin;
            for (int row = 0; row < 3; ++row)
                p[row] += glm::dot(glm::dvec4(scene.placements[i].toWorld[row]),
                                   glm::dvec4(scene.positions[v], 1));
            ASSERT_LT(glm::distance(p, mesh.positions[v] + glm::dvec3(3.0 * i, 0, 0)),
                      2 * kRounding);
        }
}

TEST(FarScenes, WhatAnAnimationMovesDoesNotMoveTheOrigin) {
    const auto moment = [](double height) {
        SceneBuilder builder("town.xyz", {});
        const std::vector<uint32_t> materials{builder.defaultMaterial()};
        const ShapeId shape = builder.addMesh("stair", stair({}));
        builder.place(kPlace, shape, movedTo(kFar), materials, "still");
        builder.place(kPlace, shape, movedTo(kFar + glm::dvec3(0, height, 0)), materials, "moving");
        builder.markMoving();
        return builder.finish();
    };
    EXPECT_EQ(moment(0).origin, moment(1000).origin);
}

TEST(FarScenes, AScenesOwnCoordinatesAreKeptWhereFloatsSuffice) {
    const Mesh mesh = stair({100, 5, -70}); // 15 times as far away as it is large
    const Scene scene = placed(mesh, {glm::dmat4(1)});
    EXPECT_EQ(scene.origin, glm::dvec3(0));
    for (size_t i = 0; i < scene.positions.size(); ++i)
        EXPECT_EQ(scene.positions[i], glm::vec3(mesh.positions[i]));
}

} // namespace
} // namespace stromboli::build
