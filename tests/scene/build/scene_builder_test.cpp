// What every loader relies on, without any format.

#include "scene/build/material_table.hpp"
#include "scene/build/polygon.hpp"
#include "scene/build/scene_builder.hpp"

#include "host/core/error.hpp"

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <string>

namespace stromboli::build {
namespace {

using testing::Contains;
using testing::HasSubstr;

const FilePlace kHere{"scene.xyz", 7, "thing"};

/// The corners (0 0 0), (1 0 0), (0 1 0), with one normal for all or none.
Mesh oneTriangle(const std::vector<glm::dvec3>& normals = {}) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.normals = normals;
    const uint32_t normal = normals.empty() ? kNoNormals : 0;
    mesh.parts = {{{Corner{0, normal}, Corner{1, normal}, Corner{2, normal}}}};
    return mesh;
}

Scene placed(const Mesh& mesh, const glm::dmat4& toWorld,
             const SceneConventions& conventions = {}) {
    SceneBuilder builder("scene.xyz", conventions);
    const std::vector<uint32_t> materials(mesh.parts.size(), builder.defaultMaterial());
    builder.place(kHere, builder.addMesh("mesh", mesh), toWorld, materials, "instance");
    return builder.finish();
}

glm::dmat4 scaledBy(double x, double y, double z) {
    return glm::scale(glm::dmat4(1), glm::dvec3(x, y, z));
}

void expectAt(const glm::dvec3& actual, const glm::dvec3& expected, double tolerance = 1e-7) {
    EXPECT_LT(glm::distance(actual, expected), tolerance)
        << actual.x << ' ' << actual.y << ' ' << actual.z;
}

TEST(SceneBuilder, PositionsAreRoundedOnceAfterAllTransformation) {
    // In single precision the large translation would swallow the tenth.
    const double far = 1 << 24;
    const glm::dmat4 there = glm::translate(glm::dmat4(1), glm::dvec3(far, 0, 0));
    Mesh mesh = oneTriangle();
    for (glm::dvec3& p : mesh.positions)
        p.x = p.x / 10 - far;
    const Scene scene = placed(mesh, there);
    ASSERT_EQ(scene.positions.size(), 3u);
    EXPECT_NEAR(scene.positions[1].x, 0.1f, 4e-9); // half an ulp of a double at 2^24
}

TEST(SceneBuilder, NormalsFollowTheInverseTranspose) {
    // The plane x + z = const under a scale of x by 2: its normal turns against the scale.
    const Scene scene = placed(oneTriangle({{1, 0, 1}}), scaledBy(2, 1, 1));
    ASSERT_EQ(scene.normals.size(), 1u);
    expectAt(scene.normals[0], glm::normalize(glm::dvec3(0.5, 0, 1)));
}

TEST(SceneBuilder, NormalsOfFlattenedMeshesAreAcrossThePlane) {
    const Scene scene = placed(oneTriangle({{0.5, 0, 1}}), scaledBy(1, 1, 0));
    ASSERT_EQ(scene.triangles.size(), 1u);
    // Shaded with the geometric normal: the two are the same.
    EXPECT_EQ(scene.triangles[0].normals[0], kNoNormals);
    expectAt(scene.geometricNormal(scene.triangles[0]), {0, 0, 1});
}

TEST(SceneBuilder, MirrorsKeepTheFront) {
    // Seen from outside, before and after: +z is the front, and -z where z is mirrored.
    expectAt(placed(oneTriangle(), scaledBy(-1, 1, 1))
                 .geometricNormal(placed(oneTriangle(), scaledBy(-1, 1, 1)).triangles[0]),
             {0, 0, 1});
    const Scene flipped = placed(oneTriangle(), scaledBy(1, 1, -1));
    expectAt(flipped.geometricNormal(flipped.triangles[0]), {0, 0, -1});
    SceneConventions asTransformed;
    asTransformed.winding = Winding::AsTransformed;
    const Scene kept = placed(oneTriangle(), scaledBy(-1, 1, 1), asTransformed);
    expectAt(kept.geometricNormal(kept.triangles[0]), {0, 0, -1});
}

TEST(SceneBuilder, TrianglesTurnTowardsTheirNormals) {
    const Scene turned = placed(oneTriangle({{0.3, 0, -1}}), glm::dmat4(1));
    expectAt(turned.geometricNormal(turned.triangles[0]), {0, 0, -1});
    SceneConventions asTransformed;
    asTransformed.winding = Winding::AsTransformed;
    const Scene kept = placed(oneTriangle({{0.3, 0, -1}}), glm::dmat4(1), asTransformed);
    expectAt(kept.geometricNormal(kept.triangles[0]), {0, 0, 1});
}

TEST(SceneBuilder, WhatHasNoAreaOrIsOutOfRangeIsLeftOutAndCounted) {
    Mesh mesh = oneTriangle();
    mesh.positions.insert(mesh.positions.end(), {{2, 0, 0}, {1e30, 0, 0}});
    const auto add = [&](uint32_t a, uint32_t b, uint32_t c) {
        mesh.parts[0].push_back(
            {Corner{a, kNoNormals}, Corner{b, kNoNormals}, Corner{c, kNoNormals}});
    };
    add(0, 1, 3);
    add(0, 1, 1);
    add(0, 4, 2);
    const Scene scene = placed(mesh, glm::dmat4(1));
    EXPECT_EQ(scene.triangles.size(), 1u);
    EXPECT_EQ(scene.positions.size(), 3u) << "positions nobody uses are not stored";
    EXPECT_THAT(scene.report.warnings,
                Contains(HasSubstr("'mesh': 3 of 4 triangles left out: 2 of zero area, 1 not")));
}

TEST(SceneBuilder, InstancesOfAShapeAreCountedTogether) {
    SceneBuilder builder("scene.xyz", {});
    Mesh mesh = oneTriangle();
    mesh.positions[2] = {2, 0, 0};
    const ShapeId shape = builder.addMesh("line", mesh);
    const uint32_t materials[] = {builder.defaultMaterial()};
    for (int i = 0; i < 3; ++i)
        builder.place(kHere, shape, glm::dmat4(1), materials, "instance");
    const Scene scene = builder.finish();
    EXPECT_EQ(scene.instances.size(), 3u);
    EXPECT_THAT(scene.report.warnings, Contains(HasSubstr("'line': 3 of 3 triangles left out")));
}

TEST(SceneBuilder, SpheresStaySpheresWhereNothingStretchesThem) {
    SceneBuilder builder("scene.xyz", {});
    const uint32_t materials[] = {builder.defaultMaterial()};
    const ShapeId sphere = builder.addSphere("ball", 2);
    builder.place(kHere, sphere, glm::translate(scaledBy(3, 3, 3), glm::dvec3(1, 0, 0)), materials,
                  "even");
    builder.place(kHere, sphere, scaledBy(0, 1, 1), materials, "flat");
    builder.place(kHere, sphere, scaledBy(1, 0, 1), materials, "flat, too");
    const Scene scene = builder.finish();
    ASSERT_EQ(scene.spheres.size(), 1u);
    EXPECT_EQ(scene.spheres[0].radius, 6);
    EXPECT_EQ(scene.spheres[0].center, glm::vec3(3, 0, 0));
    EXPECT_TRUE(scene.triangles.empty());
    EXPECT_THAT(scene.report.warnings, Contains(HasSubstr("'ball': 2 left out")));
}

/// Stretched or sheared, they are polyhedra whose corners are the sphere's, and whose normals point
/// away from it.
TEST(SceneBuilder, StretchedSpheresArePolyhedra) {
    for (const glm::dmat4& matrix : {scaledBy(3, 1, 1), glm::dmat4({1, 0, 0, 0}, {0.5, 1, 0, 0},
                                                                   {0, 0, 1, 0}, {4, 5, 6, 1})}) {
        SceneBuilder builder("scene.xyz", {});
        const uint32_t materials[] = {builder.defaultMaterial()};
        const ShapeId sphere = builder.addSphere("ball", 2);
        builder.place(kHere, sphere, matrix, materials, "egg");
        const Scene scene = builder.finish();
        EXPECT_TRUE(scene.spheres.empty());
        EXPECT_TRUE(scene.report.warnings.empty());
        ASSERT_FALSE(scene.triangles.empty());
        EXPECT_EQ(scene.instances.at(scene.triangles[0].instance), "egg");
        const glm::dmat4 toSphere = glm::inverse(matrix);
        for (const Triangle& t : scene.triangles)
            for (int i = 0; i < 3; ++i) {
                const glm::dvec3 p = glm::dvec3(scene.positions[t.corner[i]]) + scene.origin;
                const glm::dvec3 onSphere = toSphere * glm::dvec4(p, 1);
                ASSERT_NEAR(glm::length(onSphere), 2, 1e-5);
                ASSERT_GT(glm::dot(glm::dvec3(scene.normals[t.normals[i]]),
                                   glm::transpose(glm::dmat3(toSphere)) * onSphere),
                          0);
            }
    }
}

TEST(SceneBuilder, SpheresOfTheDialectCglScaleWithTheirXAxis) {
    SceneBuilder builder("scene.xyz", {});
    builder.markCglDialect();
    const uint32_t materials[] = {builder.defaultMaterial()};
    builder.place(kHere, builder.addSphere("ball", 2), scaledBy(3, 1, 1), materials, "uneven");
    const Scene scene = builder.finish();
    ASSERT_EQ(scene.spheres.size(), 1u);
    EXPECT_EQ(scene.spheres[0].radius, 6);
    EXPECT_THAT(scene.report.warnings, Contains(HasSubstr("'uneven': scaled unequally")));
}

TEST(SceneBuilder, MaterialsAreReadOnceAndWhenUsed) {
    SceneBuilder builder("scene.xyz", {});
    MaterialTable<std::string> table(builder);
    int reads = 0;
    const auto index = [&](const std::string& name) {
        return table.indexOf(name, [&] {
            ++reads;
            Material material;
            material.name = name;
            return material;
        });
    };
    EXPECT_EQ(index("a"), 0u);
    EXPECT_EQ(index("b"), 1u);
    EXPECT_EQ(index("a"), 0u);
    EXPECT_EQ(builder.defaultMaterial(), builder.defaultMaterial());
    EXPECT_EQ(reads, 2);
    EXPECT_EQ(builder.finish().materials.size(), 3u);
}

TEST(SceneBuilder, FractionsAndColoursAreKeptInRange) {
    SceneBuilder physical("scene.xyz", {});
    EXPECT_EQ(physical.reflectedFraction("albedo", {2, -1, 0.5}), glm::vec3(1, 0, 0.5));
    EXPECT_EQ(physical.lightColor("radiance", {2, -1, 0.5}), glm::vec3(2, 0, 0.5));
    EXPECT_THAT(physical.finish().report.warnings,
                testing::ElementsAre(HasSubstr("albedo: a reflected fraction outside [0, 1]"),
                                     HasSubstr("radiance: negative channels")));
    SceneConventions unclamped;
    unclamped.clampReflectedFractions = false;
    SceneBuilder other("scene.xyz", unclamped);
    EXPECT_EQ(other.reflectedFraction("albedo", {2, -1, 0.5}), glm::vec3(2, 0, 0.5));
}

TEST(SceneBuilder, LightsAreAimedByTheirMatrix) {
    SceneBuilder builder("scene.xyz", {});
    glm::dmat4 matrix = glm::rotate(glm::dmat4(1), glm::radians(90.0), glm::dvec3(0, 1, 0));
    matrix[3] = {1, 2, 3, 1};
    Light light;
    light.kind = LightKind::Spot;
    builder.placeLight(light, matrix);
    light.name = "nowhere";
    builder.placeLight(light, scaledBy(1, 1, 0));
    const Scene scene = builder.finish();
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.lights[0].position, glm::vec3(1, 2, 3));
    expectAt(scene.lights[0].direction, {-1, 0, 0});
    EXPECT_THAT(scene.report.warnings, Contains(HasSubstr("light 'nowhere' is left out")));
}

TEST(FilePlaceTest, ErrorsSayFileLineAndElement) {
    try {
        kHere.fail("is wrong");
        FAIL();
    } catch (const SceneError& error) {
        EXPECT_STREQ(error.what(), "scene.xyz:7: <thing>: is wrong");
    }
}

TEST(PolygonCutterTest, CutsReportsAndLeavesOut) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {4, 0, 0}, {1, 1, 0}, {0, 4, 0}};
    Report report;
    PolygonCutter cutter(mesh, report);
    MeshPart part;
    const Corner arrow[] = {{0, 0}, {1, 1}, {2, 2}, {3, 3}};
    cutter.add(arrow, part);
    ASSERT_EQ(part.size(), 2u);
    for (const MeshTriangle& t : part) {
        const glm::dvec3 a = mesh.positions[t[0].position];
        EXPECT_GT(
            glm::cross(mesh.positions[t[1].position] - a, mesh.positions[t[2].position] - a).z, 0);
    }
    cutter.add(std::span(arrow, 2), part);
    EXPECT_EQ(part.size(), 2u);
    LoadReport lines;
    report.writeTo(lines);
    EXPECT_THAT(lines.warnings, testing::ElementsAre(HasSubstr("fewer than 3 corners")));
}

} // namespace
} // namespace stromboli::build
