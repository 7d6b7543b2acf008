// What corners have beside position and normal comes through the builder.

#include "scene/build/scene_builder.hpp"

#include <glm/gtc/matrix_transform.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace stromboli::build {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

/// The corners (0 0 0), (1 0 0), (0 1 0) with the texture coordinates of each, and a tangent.
Mesh withAttributes(const glm::vec4& tangent = glm::vec4(0)) {
    Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    mesh.parts = {{{Corner{0, kNoNormals, 0}, Corner{1, kNoNormals, 1}, Corner{2, kNoNormals, 2}}}};
    for (const glm::dvec3& p : mesh.positions) {
        VertexAttributes attributes;
        attributes.uv[0] = attributes.uv[1] = glm::vec2(p);
        attributes.uv[1].y += 7;
        attributes.tangent = tangent;
        mesh.attributes.push_back(attributes);
    }
    return mesh;
}

Mesh withoutAttributes() {
    Mesh mesh = withAttributes();
    for (Corner& corner : mesh.parts[0][0])
        corner.attributes = kNoAttributes;
    mesh.attributes.clear();
    return mesh;
}

Scene sceneOf(const std::vector<Mesh>& meshes, const glm::dmat4& toWorld = glm::dmat4(1)) {
    SceneBuilder builder("scene.xyz", {});
    const std::vector<uint32_t> materials = {builder.defaultMaterial()};
    for (const Mesh& mesh : meshes)
        builder.place({"scene.xyz", 0, "thing"}, builder.addMesh("mesh", mesh), toWorld, materials,
                      "instance");
    return builder.finish();
}

glm::dmat4 scaled(double x, double y, double z) {
    return glm::scale(glm::dmat4(1), glm::dvec3(x, y, z));
}

TEST(Attributes, ScenesWithoutHaveNone) {
    const Scene scene = sceneOf({withoutAttributes()});
    EXPECT_TRUE(scene.attributes.empty());
    EXPECT_TRUE(scene.attributeCorners.empty());
}

TEST(Attributes, AreThoseOfTheCorners) {
    const Scene scene = sceneOf({withoutAttributes(), withAttributes(), withoutAttributes()});
    ASSERT_EQ(scene.attributeCorners.size(), 3u);
    EXPECT_THAT(scene.attributeCorners[0],
                ElementsAre(kNoAttributes, kNoAttributes, kNoAttributes));
    EXPECT_THAT(scene.attributeCorners[2],
                ElementsAre(kNoAttributes, kNoAttributes, kNoAttributes));
    for (int i = 0; i < 3; ++i) {
        const VertexAttributes& a = scene.attributes.at(scene.attributeCorners[1][i]);
        const glm::vec3& p = scene.positions[scene.triangles[1].corner[i]];
        EXPECT_EQ(a.uv[0], glm::vec2(p));
        EXPECT_EQ(a.uv[1], glm::vec2(p) + glm::vec2(0, 7));
        EXPECT_EQ(a.color, glm::vec4(1));
        EXPECT_EQ(a.tangent, glm::vec4(0));
    }
}

TEST(Attributes, StayWithTheirCornersWhereTrianglesTurn) {
    const Scene scene = sceneOf({withAttributes()}, scaled(-1, 1, 1));
    for (int i = 0; i < 3; ++i) {
        const glm::vec2 uv = scene.attributes.at(scene.attributeCorners.at(0)[i]).uv[0];
        const glm::vec3& p = scene.positions[scene.triangles[0].corner[i]];
        EXPECT_EQ(uv, glm::vec2(-p.x, p.y));
    }
}

TEST(Attributes, TangentsLieInTheTransformedSurface) {
    // Along x + y; a normal would turn the other way.
    const Scene scene = sceneOf({withAttributes({1, 1, 0, 1})}, scaled(3, 4, 1));
    const glm::vec4 tangent = scene.attributes.at(0).tangent;
    EXPECT_NEAR(tangent.x, 0.6f, 1e-7);
    EXPECT_NEAR(tangent.y, 0.8f, 1e-7);
    EXPECT_EQ(tangent.w, 1);
}

TEST(Attributes, MirrorsFlipTheSenseOfBitangents) {
    // n = z, t = x, b = y; the mirror leaves n and b and turns t: b = -(n x t).
    EXPECT_EQ(sceneOf({withAttributes({1, 0, 0, 1})}, scaled(-1, 1, 1)).attributes.at(0).tangent,
              glm::vec4(-1, 0, 0, -1));
    EXPECT_EQ(sceneOf({withAttributes({1, 0, 0, -1})}, scaled(-1, 1, 1)).attributes.at(0).tangent,
              glm::vec4(-1, 0, 0, 1));
    EXPECT_EQ(sceneOf({withAttributes({1, 0, 0, -1})}, scaled(-1, -1, 1)).attributes.at(0).tangent,
              glm::vec4(-1, 0, 0, -1));
}

TEST(Attributes, TangentsWithoutDirectionAreLeftOutAndReported) {
    const Scene scene = sceneOf({withAttributes({0, NAN, 0, 1})});
    EXPECT_EQ(scene.attributes.at(0).tangent, glm::vec4(0));
    EXPECT_THAT(scene.report.warnings,
                Contains(HasSubstr("3 corners have zero or non-finite tangents")));
}

TEST(Attributes, EmittersMadeOfAreaLightsHaveNone) {
    SceneBuilder builder("scene.xyz", {});
    const std::vector<uint32_t> materials = {builder.defaultMaterial()};
    builder.place({"scene.xyz", 0, "thing"}, builder.addMesh("mesh", withAttributes()),
                  glm::dmat4(1), materials, "instance");
    Light area;
    area.kind = LightKind::Area;
    builder.placeLight(area, glm::translate(glm::dmat4(1), glm::dvec3(0, 0, 5)));
    const Scene scene = builder.finish();
    EXPECT_EQ(scene.triangles.size(), 3u);
    EXPECT_EQ(scene.attributeCorners.size(), 3u);
}

} // namespace
} // namespace stromboli::build
