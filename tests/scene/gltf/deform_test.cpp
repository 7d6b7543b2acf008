// Morph targets, skins and animations.

#include "scene/build/file_store.hpp"
#include "tests/scene/gltf/gltf_text.hpp"

#include <cmath>

namespace stromboli::test {
namespace {

using testing::Contains;
using testing::HasSubstr;

/// The second corner of the triangle, (1 0 0) in its mesh.
glm::vec3 corner(const Scene& scene) {
    return scene.positions.at(scene.triangles.at(0).corner[1]);
}

SceneConventions at(double seconds) {
    SceneConventions conventions;
    conventions.selection.seconds = seconds;
    return conventions;
}

/// A triangle with two morph targets, which move it by x and by y.
GltfText withTargets() {
    GltfText g;
    const size_t x = g.addAccessor<float>({1, 0, 0, 1, 0, 0, 1, 0, 0}, "VEC3");
    const size_t y = g.addAccessor<float>({0, 1, 0, 0, 1, 0, 0, 1, 0}, "VEC3");
    g.addTriangle(fmt::format(R"(, "targets": [{{"POSITION": {}}}, {{"POSITION": {}}}])", x, y));
    return g;
}

TEST(GltfMorphs, TargetsHaveWeights) {
    GltfText g = withTargets();
    EXPECT_EQ(corner(load(g)), glm::vec3(1, 0, 0));
    g.arrays["meshes"][0].insert(1, R"("weights": [0.5, 2], )");
    EXPECT_EQ(corner(load(g)), glm::vec3(1.5f, 2, 0));
    g.arrays["nodes"][0] = R"({"mesh": 0, "weights": [3, 0]})";
    EXPECT_EQ(corner(load(g)), glm::vec3(4, 0, 0));
}

TEST(GltfMorphs, NormalsMoveToo) {
    GltfText g;
    const size_t normals = g.addAccessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    const size_t moved = g.addAccessor<float>({1, 0, 0, 1, 0, 0, 1, 0, 0}, "VEC3");
    g.addTriangle(fmt::format(R"(, "targets": [{{"NORMAL": {}}}])", moved),
                  fmt::format(R"(, "NORMAL": {})", normals));
    g.arrays["meshes"][0].insert(1, R"("weights": [1], )");
    expectNear(load(g).normals.at(0), glm::normalize(glm::dvec3(1, 0, 1)));
}

/// Colours stay in their range.
TEST(GltfMorphs, ColoursAndCoordinatesMoveToo) {
    GltfText g;
    const size_t colors = g.addAccessor<float>({1, 0.5f, 0, 1, 0.5f, 0, 1, 0.5f, 0}, "VEC3");
    const size_t uvs = g.addAccessor<float>({0, 0, 1, 0, 0, 1}, "VEC2");
    const size_t moved = g.addAccessor<float>({0, -0.5f, 2, 0, -0.5f, 2, 0, -0.5f, 2}, "VEC3");
    const size_t shifted = g.addAccessor<float>({3, 4, 3, 4, 3, 4}, "VEC2");
    g.addTo("images", R"("uri": "none.png")");
    g.addTriangle(
        fmt::format(R"(, "targets": [{{"COLOR_0": {}, "TEXCOORD_0": {}}}])", moved, shifted),
        fmt::format(R"(, "COLOR_0": {}, "TEXCOORD_0": {})", colors, uvs));
    g.arrays["meshes"][0].insert(1, R"("weights": [0.5], )");
    const VertexAttributes first = load(g).attributes.at(0);
    EXPECT_EQ(first.color, glm::vec4(1, 0.25f, 1, 1));
    EXPECT_EQ(first.uv[0], glm::vec2(1.5f, 2));
}

/// A triangle whose second corner follows two joints, half and half (nodes 1 and 2); the others
/// follow the first.
GltfText withSkin(float ofSecond = 0.5f) {
    GltfText g;
    const size_t joints = g.addAccessor<uint8_t>({0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0}, "VEC4");
    const size_t weights =
        g.addAccessor<float>({1, 0, 0, 0, ofSecond, ofSecond, 0, 0, 1, 0, 0, 0}, "VEC4");
    const size_t normals = g.addAccessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
    g.addTriangle("", fmt::format(R"(, "JOINTS_0": {}, "WEIGHTS_0": {}, "NORMAL": {})", joints,
                                  weights, normals));
    // The inverse of the second joint's place at rest: 10 along x.
    const size_t inverses =
        g.addAccessor<float>({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0,   0, 0, 1, //
                              1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, -10, 0, 0, 1},
                             "MAT4");
    g.addTo("skins", fmt::format(R"("joints": [1, 2], "inverseBindMatrices": {})", inverses));
    g.arrays["nodes"][0] = R"({"mesh": 0, "skin": 0, "translation": [500, 0, 0]})";
    g.addTo("nodes", "");
    g.addTo("nodes", R"("translation": [10, 6, 0])");
    g.arrays["scenes"][0] = R"({"nodes": [0, 1, 2]})";
    return g;
}

TEST(GltfSkins, FollowTheirJoints) {
    // The node's own place has no meaning; the second joint has moved by 6 along y.
    expectNear(corner(load(withSkin())), {1, 3, 0});
}

/// Exporters leave vertices out of all groups; they belong to the figure all the same.
TEST(GltfSkins, VerticesWithoutWeightsFollowTheirFirstJoint) {
    GltfText g = withSkin(0);
    g.arrays["nodes"][1] = R"({"translation": [0, 0, 7]})";
    expectNear(corner(load(g)), {1, 0, 7});
    EXPECT_THAT(load(g).report.forgiven,
                testing::ElementsAre(HasSubstr("1 vertices have no weight")));
}

TEST(GltfSkins, NormalsTurnWithJoints) {
    GltfText g = withSkin();
    // The first joint turns by a quarter about x: z becomes -y.
    g.arrays["nodes"][1] = R"({"rotation": [0.70710678118654752, 0, 0, 0.70710678118654752]})";
    const Scene scene = load(g);
    // The first and the third corner lie on x = 0 and follow it wholly.
    const Triangle& t = scene.triangles.at(0);
    EXPECT_NEAR(scene.positions[t.corner[2]].z, 1, 1e-6);
    ASSERT_NE(t.normals[0], kNoNormals);
    expectNear(scene.normals[t.normals[0]], {0, -1, 0});
}

TEST(GltfSkins, JointsMustBeThere) {
    GltfText g = withSkin();
    g.arrays["skins"][0] = R"({"joints": [1]})";
    EXPECT_EQ(problem(g), "<meshes[0].primitives[0]>: vertex 1 names joint 1 of 1");
    g.arrays["skins"][0] = R"({"joints": [1, 2, 1], "inverseBindMatrices": 4})";
    EXPECT_THAT(load(g).report.forgiven.at(0),
                HasSubstr("<skins[0].inverseBindMatrices>: has 2 matrices for 3 joints"));
}

/// A triangle whose node is moved by key frames at 1 and 3 seconds.
GltfText animated(const std::string& path, const std::string& type,
                  const std::vector<float>& values, const std::string& interpolation = "LINEAR") {
    GltfText g = withTargets();
    const size_t times = g.addAccessor<float>({1, 3}, "SCALAR");
    const size_t output = g.addAccessor<float>(values, type);
    g.addTo("animations",
            fmt::format(R"("samplers": [{{"input": {}, "output": {}, "interpolation": "{}"}}],
            "channels": [{{"sampler": 0, "target": {{"node": 0, "path": "{}"}}}}])",
                        times, output, interpolation, path));
    return g;
}

TEST(GltfAnimations, NeedATime) {
    const GltfText g = animated("translation", "VEC3", {0, 0, 0, 0, 8, 0});
    EXPECT_EQ(corner(load(g)), glm::vec3(1, 0, 0));
    EXPECT_THAT(load(g).report.ignored, Contains(HasSubstr("1 animations: what stands without")));
    GltfText still;
    still.addTriangle();
    EXPECT_EQ(problem(still, at(1)), "has no animation; --at asks for one");
}

TEST(GltfAnimations, Linear) {
    const GltfText g = animated("translation", "VEC3", {0, 0, 0, 0, 8, 0});
    EXPECT_EQ(corner(load(g, at(0))), glm::vec3(1, 0, 0));
    EXPECT_EQ(corner(load(g, at(1.5))), glm::vec3(1, 2, 0));
    EXPECT_EQ(corner(load(g, at(9))), glm::vec3(1, 8, 0));
}

TEST(GltfAnimations, Step) {
    const GltfText g = animated("scale", "VEC3", {2, 1, 1, 3, 1, 1}, "STEP");
    EXPECT_EQ(corner(load(g, at(2.9))), glm::vec3(2, 0, 0));
    EXPECT_EQ(corner(load(g, at(3))), glm::vec3(3, 0, 0));
}

TEST(GltfAnimations, RotationsGoAlongTheSphere) {
    const float s = float(std::sqrt(0.5));
    const GltfText g = animated("rotation", "VEC4", {0, 0, 0, 1, 0, 0, s, s});
    // A quarter of the way to a quarter turn.
    const double angle = M_PI / 8;
    expectNear(corner(load(g, at(1.5))), {std::cos(angle), std::sin(angle), 0}, 1e-6);
}

TEST(GltfAnimations, CubicSplines) {
    // Arriving tangent, value, leaving tangent; from 0 to 4 with the slopes 2 and -1 per second.
    const GltfText g =
        animated("translation", "VEC3", {0, 0, 0, 0, 0, 0, 0, 2, 0, 0, -1, 0, 0, 4, 0, 0, 0, 0},
                 "CUBICSPLINE");
    // Half way: (0 + 4) / 2 + 2 s (2 - -1) / 8.
    expectNear(corner(load(g, at(2))), {1, 2.75, 0});
    expectNear(corner(load(g, at(3))), {1, 4, 0});
}

TEST(GltfAnimations, Weights) {
    const GltfText g = animated("weights", "SCALAR", {0, 0, 4, 8});
    EXPECT_EQ(corner(load(g, at(2))), glm::vec3(3, 4, 0));
}

/// The moments of an animation are read from one reading of the file: it may be gone after the
/// first, and each is what a reading of its own gives.
TEST(GltfAnimations, AreReadOnce) {
    const GltfText g = animated("translation", "VEC3", {0, 0, 0, 0, 8, 0});
    const Folder folder;
    for (const bool isBinary : {false, true}) {
        const std::filesystem::path file =
            folder.write(isBinary ? "a.glb" : "a.gltf", isBinary ? g.binary() : g.text());
        SceneConventions moment = at(0);
        moment.kept = std::make_shared<build::FileStore>();
        EXPECT_EQ(corner(loadGltf(file, moment)), glm::vec3(1, 0, 0));
        std::filesystem::remove(file);
        for (const double seconds : {1.5, 9.0, 0.0}) {
            moment.selection.seconds = seconds;
            EXPECT_EQ(corner(loadGltf(file, moment)), corner(load(g, at(seconds)))) << seconds;
        }
        EXPECT_THROW(loadGltf(file, at(0)), SceneError) << "without what was kept";
    }
}

using Marks = std::vector<bool>;

TEST(GltfAnimations, MarkWhatTheyMove) {
    GltfText g = animated("translation", "VEC3", {0, 0, 0, 0, 8, 0});
    g.arrays["nodes"][0] = R"({"mesh": 0, "children": [2]})";
    g.addTo("nodes", R"("mesh": 0, "name": "still")");
    g.addTo("nodes", R"("mesh": 0, "name": "child of one that moves")");
    g.arrays["scenes"][0] = R"({"nodes": [0, 1]})";
    EXPECT_FALSE(load(g).isMoment());
    const Scene scene = load(g, at(2));
    EXPECT_TRUE(scene.isMoment());
    ASSERT_EQ(scene.instances.size(), 3u);
    for (size_t i = 0; i < 3; ++i)
        EXPECT_EQ(scene.moves(uint32_t(i)), scene.instances[i] != "still") << scene.instances[i];
    EXPECT_FALSE(scene.lightsMove);
    EXPECT_EQ(load(animated("weights", "SCALAR", {0, 0, 4, 8}), at(2)).movingInstances,
              Marks{true});
}

/// A skin moves with its joints, whatever its node does.
TEST(GltfAnimations, MarkSkinsWhoseJointsTheyMove) {
    for (const int node : {0, 1, 2}) {
        GltfText g = withSkin();
        const size_t times = g.addAccessor<float>({1, 3}, "SCALAR");
        const size_t places = g.addAccessor<float>({0, 0, 0, 0, 8, 0}, "VEC3");
        g.addTo("animations", fmt::format(R"("samplers": [{{"input": {}, "output": {}}}],
                "channels": [{{"sampler": 0, "target": {{"node": {}, "path": "translation"}}}}])",
                                          times, places, node));
        EXPECT_EQ(load(g, at(2)).isMoment(), node != 0) << node;
    }
}

TEST(GltfAnimations, MarkLightsThatTheyMove) {
    GltfText g = animated("translation", "VEC3", {0, 0, 0, 0, 8, 0});
    g.members["extensions"] = R"({"KHR_lights_punctual": {"lights": [{"type": "point"}]}})";
    g.arrays["nodes"][0] = R"({"extensions": {"KHR_lights_punctual": {"light": 0}}})";
    g.addTo("nodes", R"("mesh": 0)");
    g.arrays["scenes"][0] = R"({"nodes": [0, 1]})";
    const Scene scene = load(g, at(2));
    EXPECT_TRUE(scene.lightsMove);
    EXPECT_TRUE(scene.isMoment());
    EXPECT_FALSE(scene.moves(0));
    EXPECT_FALSE(load(g).lightsMove);
}

/// Programs write one for each object that moves; two of one object are two things that it may do.
TEST(GltfAnimations, OfOtherNodesArePlayedTogether) {
    GltfText g = animated("translation", "VEC3", {0, 0, 0, 0, 8, 0});
    g.addTo("nodes", R"("mesh": 0)");
    g.arrays["scenes"][0] = R"({"nodes": [0, 1]})";
    const size_t times = g.addAccessor<float>({1, 5}, "SCALAR");
    const size_t output = g.addAccessor<float>({0, 0, 0, 0, 0, 16}, "VEC3");
    for (const int node : {1, 0})
        g.addTo("animations", fmt::format(R"("samplers": [{{"input": {}, "output": {}}}],
            "channels": [{{"sampler": 0, "target": {{"node": {}, "path": "translation"}}}}])",
                                          times, output, node));
    const Scene scene = load(g, at(2));
    EXPECT_EQ(corner(scene), glm::vec3(1, 4, 0));
    EXPECT_EQ(scene.positions.at(scene.triangles.at(1).corner[1]), glm::vec3(1, 0, 4));
    EXPECT_EQ(scene.animationSeconds, 5);
    EXPECT_THAT(scene.report.ignored,
                Contains(HasSubstr("1 animations: the first one of each node")));
}

TEST(GltfAnimations, WrongOnes) {
    const auto said = [](const GltfText& g) {
        const Scene scene = load(g, at(1));
        EXPECT_EQ(scene.triangles.size(), 1u);
        return scene.report.forgiven.at(0);
    };
    EXPECT_THAT(said(animated("translation", "VEC3", {0, 0, 0})),
                HasSubstr("<animations[0].samplers[0].output>: has 3 numbers for 2 key frames"));
    EXPECT_THAT(said(animated("scale", "VEC3", {1, 1, 1, 1, 1, 1}, "MAGIC")),
                HasSubstr("interpolation>: is 'MAGIC', expected LINEAR, STEP or CUBICSPLINE"));
}

} // namespace
} // namespace stromboli::test
