#include "scene/build/tangents.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace stromboli::build {
namespace {

void expectTangent(const glm::vec4& tangent, const glm::dvec3& direction, float sense) {
    EXPECT_LT(glm::distance(glm::dvec3(tangent), direction), 1e-6)
        << tangent.x << ' ' << tangent.y << ' ' << tangent.z;
    EXPECT_EQ(tangent.w, sense);
}

/// Triangles of separate corners, all with the normal +z.
Mesh plane(const std::vector<glm::dvec2>& points, const std::vector<glm::vec2>& uvs) {
    Mesh mesh;
    mesh.normals = {{0, 0, 1}};
    mesh.parts = {{}};
    for (uint32_t i = 0; i < points.size(); ++i) {
        mesh.positions.emplace_back(points[i], 0);
        VertexAttributes attributes;
        attributes.uv[0] = {5, 5};
        attributes.uv[1] = uvs[i];
        mesh.attributes.push_back(attributes);
        if (i % 3 == 2)
            mesh.parts[0].push_back(
                {Corner{i - 2, 0, i - 2}, Corner{i - 1, 0, i - 1}, Corner{i, 0, i}});
    }
    return mesh;
}

const VertexAttributes& at(const Mesh& mesh, size_t triangle, size_t corner) {
    return mesh.attributes.at(mesh.parts[0].at(triangle)[corner].attributes);
}

TEST(Tangents, ShowAlongUWithTheBitangentUpThePicture) {
    // The picture stands upright: u to the right, v = 1 at the lower edge.
    Mesh mesh = plane({{0, 0}, {1, 0}, {0, 1}}, {{0, 1}, {1, 1}, {0, 0}});
    computeTangents(mesh, 0, 1);
    for (int i = 0; i < 3; ++i) {
        expectTangent(at(mesh, 0, i).tangent, {1, 0, 0}, 1);
        EXPECT_EQ(at(mesh, 0, i).uv[0], glm::vec2(5, 5));
    }
}

TEST(Tangents, OfMirroredPicturesHaveTheOtherSense) {
    Mesh mesh = plane({{0, 0}, {1, 0}, {0, 1}}, {{1, 1}, {0, 1}, {1, 0}});
    computeTangents(mesh, 0, 1);
    expectTangent(at(mesh, 0, 0).tangent, {-1, 0, 0}, -1);
}

TEST(Tangents, OfTurnedPicturesTurn) {
    // u grows upwards, v to the right: the bitangent, along which v falls, is to the left.
    Mesh mesh = plane({{0, 0}, {1, 0}, {0, 1}}, {{0, 0}, {0, 1}, {1, 0}});
    computeTangents(mesh, 0, 1);
    expectTangent(at(mesh, 0, 0).tangent, {0, 1, 0}, 1);
}

TEST(Tangents, AreWeightedByAngle) {
    // Two triangles meet in a corner of equal place: one with the angle 90 degrees there, whose
    // tangent is x, one with 45 degrees, whose tangent is y.
    Mesh mesh = plane({{0, 0}, {1, 0}, {0, 1}, {0, 0}, {0, 1}, {-1, 1}},
                      {{0, 1}, {1, 1}, {0, 0}, {0, 1}, {1, 1}, {1, 0}});
    computeTangents(mesh, 0, 1);
    const glm::dvec3 expected = glm::normalize(glm::dvec3(2, 1, 0));
    expectTangent(at(mesh, 0, 0).tangent, expected, 1);
    expectTangent(at(mesh, 1, 0).tangent, expected, 1);
    expectTangent(at(mesh, 0, 1).tangent, {1, 0, 0}, 1);
    expectTangent(at(mesh, 1, 2).tangent, {0, 1, 0}, 1);
}

TEST(Tangents, AreNotSharedAcrossAMirrorInThePicture) {
    // The picture is mirrored at the line x = 0, which both triangles share with equal uv.
    Mesh mesh = plane({{0, 0}, {1, 0}, {0, 1}, {0, 0}, {0, 1}, {-1, 0}},
                      {{0, 1}, {1, 1}, {0, 0}, {0, 1}, {0, 0}, {1, 1}});
    computeTangents(mesh, 0, 1);
    for (int i = 0; i < 3; ++i) {
        expectTangent(at(mesh, 0, i).tangent, {1, 0, 0}, 1);
        expectTangent(at(mesh, 1, i).tangent, {-1, 0, 0}, -1);
    }
}

TEST(Tangents, AreSplitWhereCornersSharedTheirAttributes) {
    Mesh mesh = plane({{0, 0}, {1, 0}, {0, 1}}, {{0, 1}, {1, 1}, {0, 0}});
    mesh.positions.push_back({-1, 0, 0});
    VertexAttributes mirrored;
    mirrored.uv[1] = {1, 1};
    mesh.attributes.push_back(mirrored);
    mesh.parts[0].push_back({Corner{0, 0, 0}, Corner{2, 0, 2}, Corner{3, 0, 3}});
    computeTangents(mesh, 0, 1);
    expectTangent(at(mesh, 0, 0).tangent, {1, 0, 0}, 1);
    expectTangent(at(mesh, 1, 0).tangent, {-1, 0, 0}, -1);
}

TEST(Tangents, OfTrianglesWithoutAreaInThePictureAreFinite) {
    Mesh alone = plane({{0, 0}, {1, 0}, {0, 1}}, {{0, 0}, {0, 0}, {0, 0}});
    computeTangents(alone, 0, 1);
    for (int i = 0; i < 3; ++i) {
        const glm::vec4 tangent = at(alone, 0, i).tangent;
        EXPECT_NEAR(glm::length(glm::dvec3(tangent)), 1, 1e-6);
        EXPECT_EQ(tangent.z, 0);
        EXPECT_EQ(std::abs(tangent.w), 1);
    }
    // Beside a whole one its corner at the same place takes that one's tangent.
    Mesh beside = plane({{0, 0}, {1, 0}, {0, 1}, {0, 0}, {0, 1}, {-1, 0}},
                        {{1, 1}, {0, 1}, {1, 0}, {1, 1}, {1, 1}, {1, 1}});
    computeTangents(beside, 0, 1);
    expectTangent(at(beside, 1, 0).tangent, {-1, 0, 0}, -1);
}

TEST(Tangents, LieAcrossTheNormals) {
    Mesh mesh = plane({{0, 0}, {1, 0}, {0, 1}}, {{0, 1}, {1, 1}, {0, 0}});
    mesh.normals = {{3, 0, 4}};
    computeTangents(mesh, 0, 1);
    expectTangent(at(mesh, 0, 0).tangent, {0.8, 0, -0.6}, 1);
}

TEST(Tangents, OfMeshesWithoutNormalsUseTheTriangles) {
    Mesh mesh = plane({{0, 0}, {1, 0}, {0, 1}}, {{0, 1}, {1, 1}, {0, 0}});
    mesh.normals.clear();
    for (Corner& corner : mesh.parts[0][0])
        corner.normal = kNoNormals;
    computeTangents(mesh, 0, 1);
    expectTangent(at(mesh, 0, 2).tangent, {1, 0, 0}, 1);
}

} // namespace
} // namespace stromboli::build
