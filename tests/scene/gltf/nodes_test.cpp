// Where meshes, cameras and lights stand.

#include "tests/scene/gltf/gltf_text.hpp"

#include <cmath>

namespace stromboli::test {
namespace {

using testing::Contains;
using testing::HasSubstr;

/// The second corner of the first triangle, (1 0 0) in its mesh, in the file's coordinates.
glm::vec3 cornerInFile(const Scene& scene) {
    return glm::dvec3(scene.positions.at(scene.triangles.at(0).corner[1])) + scene.origin;
}

TEST(GltfNodes, TranslationRotationScale) {
    GltfText g;
    g.addTriangle();
    // A quarter turn about z, which takes x to y.
    g.arrays["nodes"][0] = R"({"mesh": 0, "translation": [1, 2, 3], "scale": [4, 1, 1],
        "rotation": [0, 0, 0.70710678, 0.70710678]})";
    expectNear(cornerInFile(load(g)), {1, 6, 3});
}

TEST(GltfNodes, HiddenOnesAreNotShownNorWhatHangsOnThem) {
    GltfText g;
    g.addTriangle();
    g.addTriangle();
    g.arrays["scenes"] = {R"({"nodes": [0, 1]})"};
    EXPECT_EQ(load(g).triangles.size(), 2u);
    g.arrays["nodes"].at(0) =
        R"({"mesh": 0, "extensions": {"KHR_node_visibility": {"visible": false}}})";
    EXPECT_EQ(load(g).triangles.size(), 1u);
    EXPECT_TRUE(load(g).report.ignored.empty());
    g.arrays["nodes"].at(0) =
        R"({"mesh": 0, "extensions": {"KHR_node_visibility": {"visible": true}}})";
    EXPECT_EQ(load(g).triangles.size(), 2u);
    g.arrays["scenes"] = {R"({"nodes": [0]})"};
    g.arrays["nodes"].at(0) =
        R"({"children": [1], "extensions": {"KHR_node_visibility": {"visible": false}}})";
    EXPECT_TRUE(load(g).triangles.empty());
}

TEST(GltfNodes, Matrices) {
    GltfText g;
    g.addTriangle();
    g.arrays["nodes"][0] =
        R"({"mesh": 0, "matrix": [0, 2, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 5, 6, 7, 1]})";
    expectNear(cornerInFile(load(g)), {5, 8, 7});
}

TEST(GltfNodes, Hierarchies) {
    GltfText g;
    g.addTriangle();
    g.addTo("nodes", R"("children": [0], "translation": [0, 10, 0])");
    g.addTo("nodes", R"("children": [1], "scale": [2, 2, 2])");
    g.arrays["scenes"][0] = R"({"nodes": [2]})";
    expectNear(cornerInFile(load(g)), {2, 20, 0});
}

TEST(GltfNodes, OfTheChosenSceneAreShown) {
    GltfText g;
    g.addTriangle();
    g.addTo("nodes", R"("mesh": 0, "translation": [7, 0, 0])");
    g.addTo("scenes", R"("nodes": [1])");
    EXPECT_EQ(cornerInFile(load(g)), glm::vec3(1, 0, 0));
    EXPECT_THAT(load(g).report.ignored, Contains("1 scenes: one is shown (--scene N)"));
    g.members["scene"] = "1";
    EXPECT_EQ(cornerInFile(load(g)), glm::vec3(8, 0, 0));
    SceneConventions conventions;
    conventions.selection.scene = 0;
    EXPECT_EQ(cornerInFile(load(g, conventions)), glm::vec3(1, 0, 0));
    conventions.selection.scene = 2;
    EXPECT_EQ(problem(g, conventions), "has no scene 2: there are 2, from 0");
}

/// Exporters of several scenes leave empty ones in the file.
TEST(GltfNodes, AnEmptySceneIsShownOnlyIfItIsChosen) {
    GltfText g;
    g.addTriangle();
    g.arrays["scenes"].insert(g.arrays["scenes"].begin(), R"({"name": "empty"})");
    g.members.erase("scene");
    EXPECT_EQ(load(g).triangles.size(), 1u);
    g.members["scene"] = "0";
    EXPECT_TRUE(load(g).triangles.empty());
    SceneConventions conventions;
    conventions.selection.scene = 0;
    g.members.erase("scene");
    EXPECT_TRUE(load(g, conventions).triangles.empty());
}

TEST(GltfNodes, AllAreShownWithoutScenes) {
    GltfText g;
    g.addTriangle();
    g.arrays.erase("scenes");
    EXPECT_EQ(load(g).triangles.size(), 1u);
}

TEST(GltfNodes, MustBeTrees) {
    GltfText g;
    g.addTriangle();
    g.arrays["nodes"] = {R"({"children": [1], "mesh": 0})", R"({"children": [0]})"};
    EXPECT_EQ(problem(g), "<nodes[0]>: is on a circle of parents and children");
    g.arrays["nodes"] = {R"({"children": [0]})"};
    EXPECT_EQ(problem(g), "<nodes[0]>: is on a circle of parents and children");
    g.arrays["nodes"] = {R"({"children": [2]})", R"({"children": [2]})", "{}"};
    SceneConventions strictly;
    strictly.strict = true;
    EXPECT_THAT(problem(g, strictly),
                HasSubstr("<nodes[2]>: is a child of nodes[0] and of nodes[1], expected one"));
    g.arrays["nodes"] = {R"({"children": [5]})"};
    EXPECT_THAT(problem(g, strictly), HasSubstr("<nodes[0].children[0]>: is 5, but there is 1"));
}

TEST(GltfNodes, MayBeDeep) {
    GltfText g;
    g.addTriangle();
    constexpr int depth = 20000;
    for (int i = 1; i < depth; ++i)
        g.addTo("nodes", fmt::format(R"("children": [{}], "translation": [1, 0, 0])", i - 1));
    g.arrays["scenes"][0] = fmt::format(R"({{"nodes": [{}]}})", depth - 1);
    expectNear(cornerInFile(load(g)), {depth, 0, 0});
}

TEST(GltfNodes, InstancesOnTheGpu) {
    GltfText g;
    g.addTriangle();
    const size_t places = g.addAccessor<float>({1, 0, 0, 0, 5, 0}, "VEC3");
    const size_t scales = g.addAccessor<float>({1, 1, 1, 3, 3, 3}, "VEC3");
    g.arrays["nodes"][0] = fmt::format(
        R"({{"mesh": 0, "translation": [0, 0, 9], "extensions": {{"EXT_mesh_gpu_instancing":
        {{"attributes": {{"TRANSLATION": {}, "SCALE": {}}}}}}}}})",
        places, scales);
    const Scene scene = load(g);
    ASSERT_EQ(scene.triangles.size(), 2u);
    EXPECT_EQ(cornerInFile(scene), glm::vec3(2, 0, 9));
    EXPECT_EQ(scene.positions[scene.triangles[1].corner[1]], glm::vec3(3, 5, 9));
    std::string& node = g.arrays["nodes"][0];
    node.insert(node.find("\"SCALE\""), fmt::format("\"_COLOR_0\": {}, ", places));
    EXPECT_THAT(load(g).report.ignored, Contains(HasSubstr("'_COLOR_0' of instances")));
    const size_t three = g.addAccessor<float>({1, 0, 0, 0, 5, 0, 0, 0, 0}, "VEC3");
    g.arrays["nodes"][0] = fmt::format(
        R"({{"mesh": 0, "extensions": {{"EXT_mesh_gpu_instancing":
        {{"attributes": {{"TRANSLATION": {}, "SCALE": {}}}}}}}}})",
        places, three);
    EXPECT_THAT(load(g).report.forgiven,
                Contains(HasSubstr("attributes.SCALE>: has 3 elements, another attribute 2")));
    EXPECT_EQ(load(g).triangles.size(), 1u); // at the place of its node
}

TEST(GltfCameras, Perspective) {
    GltfText g;
    g.addTriangle();
    g.addTo("cameras", R"("type": "perspective", "name": "wide",
        "perspective": {"yfov": 1.5707963267948966, "znear": 0.5})");
    g.addTo("cameras", R"("type": "perspective",
        "perspective": {"yfov": 1.5707963267948966, "aspectRatio": 2, "znear": 1, "zfar": 9})");
    g.addTo("nodes", R"("camera": 0, "translation": [0, 0, 5])");
    g.addTo("nodes", R"("camera": 1, "name": "second")");
    g.arrays["scenes"][0] = R"({"nodes": [0, 1, 2]})";
    const Scene scene = load(g);
    ASSERT_EQ(scene.cameras.size(), 2u);
    const FileCamera& wide = scene.cameras[0];
    EXPECT_EQ(wide.name, "wide");
    EXPECT_NEAR(wide.halfHeight.value(), 1, 1e-12);
    EXPECT_FALSE(wide.halfWidth.has_value());
    EXPECT_EQ(wide.nearDistance, 0.5);
    expectNear(wide.position, {0, 0, 5});
    expectNear(wide.back, {0, 0, 1});
    EXPECT_EQ(scene.cameras[1].name, "second");
    EXPECT_NEAR(scene.cameras[1].halfWidth.value(), 2, 1e-12);
    EXPECT_EQ(scene.cameras[1].farDistance, 9);
}

TEST(GltfCameras, Orthographic) {
    GltfText g;
    g.addTriangle();
    g.addTo("cameras", R"("type": "orthographic",
        "orthographic": {"xmag": 3, "ymag": 2, "znear": 0, "zfar": 10})");
    g.arrays["nodes"][0] = R"({"mesh": 0, "camera": 0})";
    const FileCamera camera = load(g).cameras.at(0);
    EXPECT_EQ(camera.projection, Projection::Orthographic);
    EXPECT_EQ(camera.halfWidth, 3);
    EXPECT_EQ(camera.halfHeight, 2);
}

/// The light of a node, in a file that has a triangle too.
Scene withLight(const std::string& light, const std::string& node = "") {
    GltfText g;
    g.addTriangle();
    g.members["extensions"] =
        fmt::format(R"({{"KHR_lights_punctual": {{"lights": [{{{}}}]}}}})", light);
    g.arrays["nodes"][0] = fmt::format(
        R"({{"mesh": 0, "extensions": {{"KHR_lights_punctual": {{"light": 0}}}}{}}})", node);
    return load(g);
}

TEST(GltfLights, Directional) {
    const Scene scene = withLight(R"("type": "directional", "color": [1, 0.5, 0], "intensity": 4)");
    const Light& light = scene.lights.at(0);
    EXPECT_EQ(light.kind, LightKind::Directional);
    EXPECT_EQ(light.color, glm::vec3(4, 2, 0));
    EXPECT_EQ(light.direction, glm::vec3(0, 0, -1));
}

TEST(GltfLights, PointFallsOffBySquares) {
    const Scene scene = withLight(R"("type": "point", "intensity": 8, "range": 3)",
                                  R"(, "translation": [1, 2, 3], "scale": [2, 2, 2])");
    const Light& light = scene.lights.at(0);
    EXPECT_EQ(light.kind, LightKind::Point);
    EXPECT_EQ(light.color, glm::vec3(8));
    EXPECT_EQ(light.position, glm::vec3(1, 2, 3));
    EXPECT_EQ(light.constantAttenuation, 0);
    EXPECT_EQ(light.linearAttenuation, 0);
    EXPECT_EQ(light.quadraticAttenuation, 1);
    EXPECT_THAT(scene.report.ignored,
                Contains("1 ranges of lights: light does not end at a distance"));
}

TEST(GltfLights, SpotsHaveTwoCones) {
    const Light light =
        withLight(R"("type": "spot", "spot": {"innerConeAngle": 0.25, "outerConeAngle": 0.5})")
            .lights.at(0);
    EXPECT_EQ(light.kind, LightKind::Spot);
    EXPECT_FLOAT_EQ(light.falloffAngle, 1.0f);
    EXPECT_FLOAT_EQ(light.innerAngle.value(), 0.5f);
    const Light plain = withLight(R"("type": "spot", "spot": {})").lights.at(0);
    EXPECT_FLOAT_EQ(plain.falloffAngle, float(M_PI / 2));
    EXPECT_EQ(plain.innerAngle, 0.0f);
    const Light sharp =
        withLight(R"("type": "spot", "spot": {"innerConeAngle": 0.5, "outerConeAngle": 0.5})")
            .lights.at(0);
    EXPECT_FALSE(sharp.innerAngle.has_value());
}

} // namespace
} // namespace stromboli::test
