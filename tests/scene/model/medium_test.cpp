// Which medium a place is in, and densities between the cells of a grid.
#include "scene/model/scene.hpp"

#include <gtest/gtest.h>

namespace stromboli {
namespace {

/// A scene of media 0 to n - 1.
Scene withMedia(size_t n) {
    Scene scene;
    scene.media.resize(n);
    return scene;
}

uint32_t border(Scene& scene, uint32_t inside, uint32_t outside) {
    Material m;
    m.boundsMedia = true;
    m.inside = inside;
    m.outside = outside;
    scene.materials.push_back(m);
    return uint32_t(scene.materials.size() - 1);
}

/// A tetrahedron about the origin, normals outwards, whose faces are 1/3 from it; its triangles.
uint32_t addTetrahedron(Scene& scene, uint32_t material) {
    const auto first = uint32_t(scene.positions.size());
    for (const glm::vec3 corner :
         {glm::vec3(1, 1, 1), glm::vec3(1, -1, -1), glm::vec3(-1, 1, -1), glm::vec3(-1, -1, 1)})
        scene.positions.push_back(corner);
    for (const glm::uvec3 face :
         {glm::uvec3(0, 1, 2), glm::uvec3(0, 3, 1), glm::uvec3(0, 2, 3), glm::uvec3(1, 3, 2)}) {
        Triangle t;
        for (int i = 0; i < 3; ++i)
            t.corner[i] = first + face[i];
        t.material = material;
        scene.triangles.push_back(t);
    }
    return 4;
}

TEST(MediumAt, IsThatOfTheFirstBorder) {
    Scene scene = withMedia(2);
    scene.spheres.push_back({{0, 0, 0}, 2, border(scene, 0, kNoMedium)});
    scene.spheres.push_back({{0.5f, 0, 0}, 0.5f, border(scene, 1, 0)});
    EXPECT_EQ(mediumAt(scene, {5, 0, 0}), kNoMedium);
    EXPECT_EQ(mediumAt(scene, {-1.5, 0.3, 0}), 0u);
    EXPECT_EQ(mediumAt(scene, {0.6, 0.1, 0}), 1u);
    EXPECT_EQ(mediumAt(scene, {0, 0, 0}), 1u); // the middle of all borders, and in both balls
}

TEST(MediumAt, IsWhatSurroundsTheSceneWhereThereIsNoBorder) {
    Scene scene = withMedia(1);
    EXPECT_EQ(mediumAt(scene, {1, 2, 3}), kNoMedium);
    scene.surrounding = 0;
    EXPECT_EQ(mediumAt(scene, {1, 2, 3}), 0u);
    // Other surfaces do not count.
    scene.materials.emplace_back();
    scene.spheres.push_back({{0, 0, 0}, 1, 0});
    EXPECT_EQ(mediumAt(scene, {0.1, 0, 0}), 0u);
}

TEST(MediumAt, GoesByTheNormalsOfTriangles) {
    Scene scene = withMedia(2);
    addTetrahedron(scene, border(scene, 0, 1));
    EXPECT_EQ(mediumAt(scene, {0.05, 0.1, -0.02}), 0u);
    EXPECT_EQ(mediumAt(scene, {3, 1, 2}), 1u);
}

/// A box of two triangles a side, normals outwards, as files' cubes are.
void addBox(Scene& scene, const glm::dvec3& center, const glm::dvec3& half, uint32_t material) {
    for (int axis = 0; axis < 3; ++axis)
        for (const double side : {-1.0, 1.0}) {
            const auto first = uint32_t(scene.positions.size());
            for (const glm::dvec2 corner :
                 {glm::dvec2(-1, -1), glm::dvec2(1, -1), glm::dvec2(1, 1), glm::dvec2(-1, 1)}) {
                glm::dvec3 p;
                p[axis] = side;
                p[(axis + 1) % 3] = side * corner.x;
                p[(axis + 2) % 3] = corner.y;
                scene.positions.emplace_back(center + half * p);
            }
            for (const glm::uvec3 corners : {glm::uvec3(0, 1, 2), glm::uvec3(0, 2, 3)}) {
                Triangle t;
                for (int i = 0; i < 3; ++i)
                    t.corner[i] = first + corners[i];
                t.material = material;
                scene.triangles.push_back(t);
            }
        }
}

/// Cameras in front of a cube look at the middle of a side, where its two triangles meet, but for
/// the rounding of their place.
TEST(MediumAt, IsNotMistakenWhereTrianglesMeet) {
    size_t wrong = 0;
    for (int i = 0; i < 400; ++i) {
        Scene scene = withMedia(2);
        const glm::dvec3 center(0.1 * (i % 20), 0.1 * (i / 20), -0.5), half(1.6, 1.6, 0.8);
        addBox(scene, center, half, border(scene, 0, 1));
        glm::dvec3 place = glm::dvec3(glm::vec3(center));
        wrong += mediumAt(scene, place) != 0;
        for (const double z : {-6.0, -5.0, 5.0, 6.0}) {
            place.z = z;
            wrong += mediumAt(scene, place) != 1;
        }
    }
    EXPECT_EQ(wrong, 0u);
}

/// A mirrored instance has its inside inside.
TEST(MediumAt, KnowsInstances) {
    for (const float side : {1.0f, -1.0f}) {
        Scene scene = withMedia(2);
        const uint32_t triangles = addTetrahedron(scene, border(scene, 0, 1));
        scene.prototypes.push_back({0, triangles});
        Placement placement;
        placement.toWorld = {glm::vec4(2 * side, 0, 0, 10), glm::vec4(0, 2, 0, 0),
                             glm::vec4(0, 0, 2, 0)};
        scene.placements.push_back(placement);
        EXPECT_EQ(mediumAt(scene, {10.1, 0.2, 0.1}), 0u) << side;
        EXPECT_EQ(mediumAt(scene, {0, 0, 0}), 1u) << side;
    }
}

/// At the middles of cells there are the values, between them their means, beyond the outermost
/// middles the last ones, and outside of the cube nothing.
TEST(DensityGrid, IsLinearBetweenItsCells) {
    DensityGrid grid;
    grid.size = {2, 1, 2};
    grid.values = {1, 3, 5, 11};
    EXPECT_DOUBLE_EQ(grid.at({0.25, 0.5, 0.25}), 1);
    EXPECT_DOUBLE_EQ(grid.at({0.5, 0.9, 0.25}), 2);
    EXPECT_DOUBLE_EQ(grid.at({0.5, 0.1, 0.5}), 5);
    EXPECT_DOUBLE_EQ(grid.at({1, 0, 1}), 11);
    EXPECT_DOUBLE_EQ(grid.at({1.001, 0, 1}), 0);
    EXPECT_FLOAT_EQ(grid.largest(), 11);
}

} // namespace
} // namespace stromboli
