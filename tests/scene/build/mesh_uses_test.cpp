// Which meshes share their triangles, and that what is shared is where its copies would be.

#include "host/cs184/cs184.hpp"
#include "scene/build/scene_builder.hpp"
#include "scene/model/placements.hpp"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include <set>

namespace stromboli::build {
namespace {

const FilePlace kThing{"scene.xyz", 7, "thing"};

/// A tetrahedron with a normal at each corner.
Mesh tetrahedron() {
    Mesh mesh;
    mesh.positions = {{1, 1, 1}, {1, -1, -1}, {-1, 1, -1}, {-1, -1, 1}};
    mesh.normals = mesh.positions;
    MeshPart part;
    for (const auto& [a, b, c] : {std::array{0u, 1u, 2u}, {0u, 3u, 1u}, {0u, 2u, 3u}, {1u, 3u, 2u}})
        part.push_back({Corner{a, a}, Corner{b, b}, Corner{c, c}});
    mesh.parts = {part};
    return mesh;
}

glm::dmat4 at(double x, const glm::dvec3& scale = glm::dvec3(1)) {
    return glm::scale(glm::translate(glm::dmat4(1), glm::dvec3(x, 0, 0)), scale);
}

SceneConventions sharing(InstanceSharing how) {
    SceneConventions conventions;
    conventions.instances = how;
    return conventions;
}

/// The tetrahedron at three places, the second of which mirrors it, and alone in another material.
Scene fourTetrahedra(const SceneConventions& conventions, const glm::vec3& emission = {}) {
    SceneBuilder builder("scene.xyz", conventions);
    Material shared, other;
    shared.emission = emission;
    const std::array a{builder.addMaterial(shared)}, b{builder.addMaterial(other)};
    const ShapeId shape = builder.addMesh("mesh", tetrahedron());
    builder.place(kThing, shape, at(0), a, "first");
    builder.place(kThing, shape, at(10, {-1, 2, 1}), a, "second");
    builder.place(kThing, shape, at(20), b, "other");
    builder.place(kThing, shape, at(30), a, "third");
    return builder.finish();
}

TEST(MeshUses, ShareWhereTheyAreAskedTo) {
    const Scene scene = fourTetrahedra(sharing(InstanceSharing::On));
    ASSERT_EQ(scene.prototypes.size(), 1u);
    EXPECT_EQ(scene.placements.size(), 3u);
    EXPECT_EQ(scene.triangles.size(), 8u);
    EXPECT_EQ(scene.firstInWorld(), 4u);
    EXPECT_EQ(scene.placedTriangles(), 16u);
    std::set<std::string> names;
    for (const Placement& p : scene.placements)
        names.insert(scene.instances[p.instance]);
    EXPECT_EQ(names, (std::set<std::string>{"first", "second", "third"}));
    EXPECT_EQ(scene.instances[scene.triangles[4].instance], "other");
}

TEST(MeshUses, AreCopiedWhereCopiesAreFew) {
    EXPECT_TRUE(fourTetrahedra(sharing(InstanceSharing::Automatic)).placements.empty());
    EXPECT_TRUE(fourTetrahedra(sharing(InstanceSharing::Off)).placements.empty());
}

TEST(MeshUses, ShareWhereCopiesAreMany) {
    SceneBuilder builder("scene.xyz", sharing(InstanceSharing::Automatic));
    Mesh mesh = tetrahedron();
    const MeshPart four = mesh.parts[0];
    for (int i = 0; i < 300; ++i)
        mesh.parts[0].insert(mesh.parts[0].end(), four.begin(), four.end());
    const std::array material{builder.addMaterial({})};
    const ShapeId shape = builder.addMesh("mesh", mesh);
    for (int i = 0; i < 1000; ++i)
        builder.place(kThing, shape, at(3 * i), material, "one");
    const Scene scene = builder.finish();
    EXPECT_EQ(scene.placements.size(), 1000u);
    EXPECT_EQ(scene.triangles.size(), 1204u);
}

TEST(MeshUses, EmittersAreCopied) {
    EXPECT_TRUE(fourTetrahedra(sharing(InstanceSharing::On), glm::vec3(1)).placements.empty());
}

TEST(MeshUses, FlatMatricesAreCopied) {
    SceneBuilder builder("scene.xyz", sharing(InstanceSharing::On));
    const std::array material{builder.addMaterial({})};
    const ShapeId shape = builder.addMesh("mesh", tetrahedron());
    for (int i = 0; i < 3; ++i)
        builder.place(kThing, shape, at(3 * i, {1, 0, 1}), material, "flat");
    EXPECT_TRUE(builder.finish().placements.empty());
}

TEST(MeshUses, OtherWindingsAreCopied) {
    SceneConventions conventions = cs184Conventions();
    conventions.instances = InstanceSharing::On;
    EXPECT_TRUE(fourTetrahedra(conventions).placements.empty());
}

/// Corners and normals of what is shared, against those that the builder makes of copies.
TEST(MeshUses, SharedIsWhereCopiesAre) {
    const Scene expanded = expandPlacements(fourTetrahedra(sharing(InstanceSharing::On))).scene;
    const Scene copied = fourTetrahedra(sharing(InstanceSharing::Off));
    ASSERT_EQ(expanded.triangles.size(), copied.triangles.size());
    size_t found = 0;
    for (const Triangle& c : copied.triangles)
        for (const Triangle& e : expanded.triangles) {
            if (copied.instances[c.instance] != expanded.instances[e.instance]) continue;
            float apart = glm::distance(copied.geometricNormal(c), expanded.geometricNormal(e));
            for (int i = 0; i < 3; ++i) {
                // Mirrored triangles may begin at another corner.
                float nearest = 1e30f;
                for (int j = 0; j < 3; ++j)
                    nearest = std::min(nearest, glm::distance(copied.positions[c.corner[i]],
                                                              expanded.positions[e.corner[j]]) +
                                                    glm::distance(copied.normals[c.normals[i]],
                                                                  expanded.normals[e.normals[j]]));
                apart += nearest;
            }
            found += apart < 1e-4f;
        }
    EXPECT_EQ(found, copied.triangles.size());
}

} // namespace
} // namespace stromboli::build
