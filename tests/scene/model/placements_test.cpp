// What placements make of the points, normals, boxes and tangents of their prototypes.

#include "scene/model/placements.hpp"

#include "host/core/error.hpp"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <limits>
#include <random>

namespace stromboli {
namespace {

glm::dmat4 someMatrix(bool mirrors) {
    glm::dmat4 m = glm::translate(glm::dmat4(1), glm::dvec3(3, -20, 7));
    m = glm::rotate(m, 1.1, glm::normalize(glm::dvec3(1, 2, -0.5)));
    return glm::scale(m, glm::dvec3(mirrors ? -2.0 : 2.0, 0.5, 3));
}

/// One triangle in its own space, with a normal and a tangent.
Scene oneTriangle(const glm::dmat4& toWorld) {
    Scene scene;
    scene.positions = {{0, 0, 0}, {1, 0, 0}, {0.25f, 1, 0.5f}};
    const glm::vec3 across = glm::cross(scene.positions[1], scene.positions[2]);
    scene.normals = {glm::normalize(across)};
    Triangle t;
    for (uint32_t c = 0; c < 3; ++c)
        t.corner[c] = c, t.normals[c] = 0;
    scene.triangles = {t};
    VertexAttributes a;
    a.tangent = {1, 0, 0, 1};
    scene.attributes = {a};
    scene.attributeCorners = {{0, 0, 0}};
    scene.materials.resize(1);
    scene.prototypes = {{0, 1}};
    scene.placements = {*placementOf(toWorld)};
    scene.instances = {"a", "b"};
    scene.placements[0].instance = 1;
    return scene;
}

TEST(Placements, PointsAreWhereTheMatrixPutsThem) {
    const glm::dmat4 m = someMatrix(false);
    const Placement placement = *placementOf(m);
    const glm::vec3 p(0.3f, -1.7f, 12);
    const glm::dvec3 exact(m * glm::dvec4(p, 1)), found(placed(placement, p));
    EXPECT_LT(glm::distance(exact, found), 1e-5);
}

TEST(Placements, MatricesAreInverse) {
    for (const double size : {1e-12, 1.0, 1e12}) {
        const PlacementMatrices m = matricesOf(
            *placementOf(someMatrix(true) * glm::scale(glm::dmat4(1), glm::dvec3(size))));
        const glm::dmat3 product = m.inverseLinear * m.linear;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j)
                EXPECT_NEAR(product[i][j], i == j ? 1 : 0, 1e-12) << size;
        EXPECT_TRUE(m.mirrors);
    }
}

TEST(Placements, MatricesThatAreNoUseAreRefused) {
    EXPECT_FALSE(placementOf(glm::scale(glm::dmat4(1), glm::dvec3(1, 0, 1))));
    EXPECT_FALSE(placementOf(glm::scale(glm::dmat4(1), glm::dvec3(1, 1e-6, 1))));
    EXPECT_FALSE(placementOf(glm::dmat4(std::numeric_limits<double>::quiet_NaN())));
    EXPECT_FALSE(placementOf(glm::dmat4(1e300)));
    EXPECT_TRUE(placementOf(glm::scale(glm::dmat4(1), glm::dvec3(1, 1e-4, 1))));
}

TEST(Placements, BoxesHoldAllCorners) {
    std::mt19937 random(7);
    std::uniform_real_distribution<float> unit(-1, 1);
    for (int i = 0; i < 10000; ++i) {
        glm::dmat4 m(1);
        for (int column = 0; column < 4; ++column)
            for (int row = 0; row < 3; ++row)
                m[column][row] = unit(random) * (column == 3 ? 1000 : 1);
        const std::optional<Placement> placement = placementOf(m);
        if (!placement) continue;
        Bounds box;
        std::vector<glm::vec3> points;
        for (int p = 0; p < 3; ++p) {
            points.emplace_back(unit(random), unit(random), unit(random));
            box.extend(points.back());
        }
        const Bounds world = boundsInWorld(*placement, box);
        for (const glm::vec3& p : points) {
            const glm::vec3 at = placed(*placement, p);
            for (int axis = 0; axis < 3; ++axis) {
                EXPECT_LE(world.lo[axis], at[axis]);
                EXPECT_GE(world.hi[axis], at[axis]);
            }
        }
    }
}

/// Far from the prototype's origin, and near the world's: there corners have the rounding of
/// numbers that are much larger than they are.
TEST(Placements, BoxesHoldCornersWhoseTermsCancel) {
    std::mt19937 random(8);
    std::uniform_real_distribution<float> unit(-1, 1);
    for (int i = 0; i < 10000; ++i) {
        const glm::vec3 point = 1000.0f * glm::vec3(unit(random), unit(random), unit(random));
        glm::dmat4 m(1);
        for (int column = 0; column < 3; ++column)
            for (int row = 0; row < 3; ++row)
                m[column][row] = unit(random);
        m[3] = glm::dvec4(-glm::dvec3(m * glm::dvec4(point, 0)), 1);
        const std::optional<Placement> placement = placementOf(m);
        if (!placement) continue;
        Bounds box;
        box.extend(point);
        const Bounds world = boundsInWorld(*placement, box);
        const glm::vec3 at = placed(*placement, point);
        for (int axis = 0; axis < 3; ++axis) {
            EXPECT_LE(world.lo[axis], at[axis]);
            EXPECT_GE(world.hi[axis], at[axis]);
        }
    }
}

TEST(Placements, CopiesKeepTheSideOfTheirNormals) {
    for (const bool mirrors : {false, true}) {
        const Scene scene = oneTriangle(someMatrix(mirrors));
        const ExpandedScene expanded = expandPlacements(scene);
        const Triangle& t = expanded.scene.triangles.at(0);
        const glm::vec3 shading = expanded.scene.normals.at(t.normals[0]);
        EXPECT_NEAR(glm::dot(shading, expanded.scene.geometricNormal(t)), 1, 1e-5) << mirrors;
        EXPECT_EQ(t.instance, 1u);
        EXPECT_EQ(expanded.triangleOf, std::vector<uint32_t>{0});
        EXPECT_EQ(expanded.placementOf, std::vector<uint32_t>{0});
    }
}

TEST(Placements, TangentsGoWithTheSurface) {
    for (const bool mirrors : {false, true}) {
        const glm::dmat4 m = someMatrix(mirrors);
        const Scene scene = oneTriangle(m);
        const ExpandedScene expanded = expandPlacements(scene);
        const auto& corners = expanded.scene.attributeCorners.at(0);
        const glm::vec4 tangent = expanded.scene.attributes.at(corners[0]).tangent;
        // The bitangent w (n x t) of the mesh, transformed, is on the side of the copy's.
        const glm::dvec3 n(scene.normals[0]), t(1, 0, 0);
        const glm::dvec3 bitangent = glm::dmat3(m) * glm::cross(n, t);
        const glm::dvec3 copied =
            double(tangent.w) *
            glm::cross(glm::dvec3(expanded.scene.normals.at(0)), glm::dvec3(glm::vec3(tangent)));
        EXPECT_GT(glm::dot(glm::normalize(bitangent), copied), 0.1) << mirrors;
        EXPECT_NEAR(glm::dot(glm::normalize(glm::dmat3(m) * t), glm::dvec3(glm::vec3(tangent))), 1,
                    1e-5);
    }
}

TEST(Placements, AreCountedInTheWorld) {
    Scene scene = oneTriangle(someMatrix(false));
    scene.placements.push_back(scene.placements[0]);
    EXPECT_EQ(scene.placedTriangles(), 2u);
    EXPECT_EQ(scene.firstInWorld(), 1u);
    const Bounds bounds = scene.bounds();
    for (const glm::vec3& p : scene.positions)
        EXPECT_GE(bounds.hi.z, placed(scene.placements[0], p).z);
    EXPECT_LT(bounds.hi.x, 6.0f) << "the prototype's own space is not part of the world";
    EXPECT_LT(bounds.lo.y, -19.0f);
    EXPECT_LT(bounds.hi.y, -15.0f);
}

TEST(Placements, TooManyCopiesAreRefused) {
    Scene scene = oneTriangle(someMatrix(false));
    scene.prototypes[0].triangles = 1u << 27;
    scene.placements.resize(3, scene.placements[0]);
    EXPECT_THROW(expandPlacements(scene), SceneError);
}

} // namespace
} // namespace stromboli
