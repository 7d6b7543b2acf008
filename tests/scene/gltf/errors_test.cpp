// Wrong files give one line that names the file, the element and what was expected.

#include "scene/read_scene.hpp"
#include "tests/scene/gltf/forgiven.hpp"

#include <cmath>
#include <filesystem>
#include <random>

namespace stromboli::test {
namespace {

using testing::Contains;
using testing::HasSubstr;

TEST(GltfErrors, OnePictureCostsNoScene) {
    GltfText g;
    g.arrays["images"] = {R"({"uri": "none.png"})"};
    g.arrays["textures"] = {R"({"source": 0})"};
    g.addTo("materials", R"("pbrMetallicRoughness": {"baseColorFactor": [0.5, 1, 1, 1],
        "baseColorTexture": {"index": 0}})");
    g.addTriangle(R"(, "material": 0)");
    const Scene scene = load(g);
    EXPECT_EQ(scene.triangles.size(), 1u);
    EXPECT_TRUE(scene.textures.empty());
    ASSERT_EQ(scene.report.forgiven.size(), 1u);
    EXPECT_THAT(scene.report.forgiven[0], HasSubstr("<images[0]>"));
    EXPECT_THAT(scene.report.forgiven[0], HasSubstr("there is no picture on the surface"));
    EXPECT_THROW(load(g, strictly()), SceneError);
}

TEST(GltfErrors, OneMeshCostsNoScene) {
    GltfText g = triangle();
    g.addTriangle();
    g.arrays["scenes"] = {R"({"nodes": [0, 1]})"};
    g.arrays["meshes"].at(1) = R"({"primitives": [{"attributes": {"POSITION": 99}}]})";
    const Scene scene = load(g);
    EXPECT_EQ(scene.triangles.size(), 1u);
    EXPECT_THAT(scene.report.forgiven, Contains(HasSubstr("it is left out")));
    EXPECT_THROW(load(g, strictly()), SceneError);
}

TEST(GltfErrors, Json) {
    EXPECT_EQ(gltfProblem("{\"asset\": {\"version\": \"2.0\"},\n\n \"nodes\": [}"),
              "is no glTF: its JSON is wrong in line 3");
    EXPECT_THAT(gltfProblem(""), HasSubstr("is no glTF: its JSON is wrong in line 1"));
    EXPECT_EQ(gltfProblem("[]"), "is no object, expected {...}");
    EXPECT_EQ(gltfProblem("{}"), "is no glTF 2.0: it has no 'asset'");
    EXPECT_THAT(gltfProblem("{\"asset\": {\"version\": oops}}"), HasSubstr("wrong in line 1"));
    EXPECT_EQ(gltfProblem("{\"asset\": 1e999}"),
              "is no glTF: its JSON has a number beyond the range of double");
    EXPECT_EQ(gltfProblem(std::string(500000, '[')),
              "is no glTF: brackets go deeper than 256 levels");
}

/// What people and programs add to JSON by mistake; the text is otherwise that of a triangle.
TEST(GltfErrors, JsonThatIsNearlyRight) {
    const std::string right = triangle().text();
    ASSERT_TRUE(right.starts_with("{") && right.ends_with("}"));
    const std::string inside = right.substr(1, right.size() - 2);
    const std::string texts[] = {
        "{ // by hand, {\n" + inside + "}",
        "{ /* by hand,\n * \" { */ " + inside + "}",
        "{" + inside + ",\n}",
        "{" + inside + R"(, "extras": [1, 2, "http://a/*,]" , ], "more": "\", }"})",
        "{" + inside + R"(, "extras": [NaN, -Infinity, inf]})",
    };
    for (const std::string& text : texts) {
        EXPECT_EQ(gltfProblem(text), "") << text;
        EXPECT_THAT(gltfProblem(text, strictly()), HasSubstr("its JSON is wrong")) << text;
    }
    // A comment may hold what is wrong itself; what is no comment stays wrong, in the file's lines.
    EXPECT_THAT(gltfProblem("{ // ,\n" + inside + ", oops}"), HasSubstr("is no glTF"));
    EXPECT_THAT(gltfProblem("{ /* \n" + inside + "}"), HasSubstr("wrong in line 1"));
}

TEST(GltfErrors, TextInUtf16) {
    for (const bool isMarked : {true, false}) {
        std::string text = isMarked ? "\xFF\xFE" : "";
        for (const char c : triangle().text())
            text += {c, '\0'};
        EXPECT_EQ(gltfProblem(text), "");
        EXPECT_THAT(gltfProblem(text, strictly()), HasSubstr("is in UTF-16"));
    }
    EXPECT_EQ(gltfProblem("\xEF\xBB\xBF" + triangle().text(), strictly()), "");
}

TEST(GltfErrors, Versions) {
    GltfText g = triangle();
    g.members["asset"] = R"({"version": "1.0"})";
    EXPECT_EQ(problem(g), "<asset.version>: is '1.0', expected 2.0");
    EXPECT_EQ(gltfProblem("{}"), "is no glTF 2.0: it has no 'asset'");
    EXPECT_EQ(gltfProblem(R"({"asset": {}})"), "<asset>: has no 'version'");
}

TEST(GltfErrors, RequiredExtensions) {
    GltfText g = triangle();
    g.members["extensionsUsed"] = R"(["EXT_black_holes", "KHR_texture_transform"])";
    EXPECT_THAT(load(g).report.ignored,
                testing::ElementsAre("1 extension 'EXT_black_holes': it is not read"));
    g.members["extensionsRequired"] = R"(["KHR_texture_transform", "EXT_black_holes"])";
    const Scene scene = load(g);
    EXPECT_EQ(scene.triangles.size(), 1u);
    EXPECT_THAT(scene.report.forgiven,
                Contains(HasSubstr("<extensionsRequired>: the file requires 'EXT_black_holes'")));
    EXPECT_THROW(load(g, strictly()), SceneError);
}

TEST(GltfErrors, WrongTypes) {
    GltfText g = triangle();
    g.arrays["nodes"][0] = R"({"mesh": "first"})";
    EXPECT_EQ(problem(g), "<nodes[0].mesh>: is no number");
    g.arrays["nodes"][0] = R"({"mesh": 0.5})";
    EXPECT_EQ(problem(g), "<nodes[0].mesh>: is 0.5, expected a whole number of at least 0");
    g.arrays["nodes"][0] = R"({"mesh": 4})";
    EXPECT_EQ(problem(g), "<nodes[0].mesh>: is 4, but there is 1");
    g.arrays["nodes"][0] = "7";
    EXPECT_EQ(problem(g), "<nodes[0]>: is no object, expected {...}");
}

/// What the arrays of a file show to be version 2 is read as it.
TEST(GltfErrors, VersionsMayBeForgotten) {
    GltfText g = triangle();
    const char* const reading = "the file is read as glTF 2.0";
    g.members["asset"] = "{}";
    expectForgiven(g, "<asset>: has no 'version'", reading);
    g.members["asset"] = R"({"version": "2.1", "minVersion": "2.1"})";
    expectForgiven(g, "<asset.minVersion>: is '2.1'", reading);
    g.members.erase("asset");
    expectForgiven(g, "has no 'asset'", reading);
}

TEST(GltfErrors, OneNumberCostsItself) {
    const char* const defaults = "its default is taken";
    for (const auto& [member, wrong] : std::vector<std::pair<std::string, std::string>>{
             {R"("translation": [1, 2])", "translation>: has 2 numbers, expected 3"},
             {R"("rotation": [0, 0, 0, 0])", "rotation>: has no direction"},
             {R"("rotation": "none")", "rotation>: is no array, expected [...]"},
             {R"("matrix": [1, 2, 3])", "matrix>: has 3 numbers, expected 16"},
             {R"("weights": ["much"])", "weights[0]>: is no number"}}) {
        GltfText g = triangle();
        g.arrays["nodes"][0] = fmt::format(R"({{"mesh": 0, {}}})", member);
        expectForgiven(g, "<nodes[0]." + wrong, defaults);
        EXPECT_EQ(load(g).positions.at(0), glm::vec3(0));
    }
    for (const auto& [members, wrong] : std::vector<std::pair<std::string, std::string>>{
             {R"("pbrMetallicRoughness": {"baseColorFactor": [1, 1, "blue", 1]})",
              "pbrMetallicRoughness.baseColorFactor[2]>: is no number"},
             {R"("pbrMetallicRoughness": {"roughnessFactor": "0.5"})",
              "pbrMetallicRoughness.roughnessFactor>: is no number"},
             {R"("doubleSided": true, "alphaMode": "GLASS")",
              "alphaMode>: is 'GLASS', expected OPAQUE, MASK or BLEND"}}) {
        GltfText g;
        g.addTriangle(R"(, "material": 0)");
        g.addTo("materials", R"("emissiveFactor": [0.5, 1, 1], )" + members);
        expectForgiven(g, "<materials[0]." + wrong, defaults);
        EXPECT_EQ(load(g).materials.at(0).emission.x, 0.5f); // the rest is read
    }
}

TEST(GltfErrors, OneMaterialCostsItself) {
    GltfText g;
    g.addTriangle(R"(, "material": 0)");
    g.arrays["materials"] = {"7"};
    expectForgiven(g, "<materials[0]>: is no object, expected {...}", "mid grey takes its place");
}

TEST(GltfErrors, OneCameraOrLightCostsItself) {
    const auto withLight = [](const std::string& light) {
        GltfText g = triangle();
        g.members["extensions"] =
            fmt::format(R"({{"KHR_lights_punctual": {{"lights": [{}]}}}})", light);
        g.arrays["nodes"][0] =
            R"({"mesh": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}})";
        return g;
    };
    const std::string light = "<extensions.KHR_lights_punctual.lights[0]";
    expectForgiven(withLight(R"({"type": "lantern"})"),
                   light + ".type>: is 'lantern', expected directional, point or spot",
                   "it is left out");
    expectForgiven(withLight("[]"), light + ">: is no object, expected {...}", "it is left out");
    const GltfText dim = withLight(R"({"type": "point", "intensity": "much"})");
    expectForgiven(dim, light + ".intensity>: is no number", "its default is taken");
    EXPECT_EQ(load(dim).lights.size(), 1u);

    const auto withCamera = [](const std::string& camera) {
        GltfText g = triangle();
        g.arrays["cameras"] = {camera};
        g.arrays["nodes"][0] = R"({"mesh": 0, "camera": 0})";
        return g;
    };
    expectForgiven(withCamera(R"({"type": "perspective", "perspective": {"yfov": -1}})"),
                   "<cameras[0].perspective.yfov>: is -1, expected more than 0", "it is left out");
    const GltfText near =
        withCamera(R"({"type": "perspective", "perspective": {"yfov": 1, "znear": 2, "zfar": 1}})");
    expectForgiven(near, "<cameras[0].perspective.zfar>: is 1, expected more than znear, 2",
                   "its default is taken");
    EXPECT_EQ(load(near).cameras.size(), 1u);
}

/// The widest cone that the format has, pi / 2, is more than that in single precision.
TEST(GltfErrors, SpotsOfHalfATurn) {
    GltfText g = triangle();
    g.members["extensions"] = R"({"KHR_lights_punctual": {"lights": [
        {"type": "spot", "spot": {"outerConeAngle": 1.57079637, "innerConeAngle": 1.57079637}}]}})";
    g.arrays["nodes"][0] = R"({"mesh": 0, "extensions": {"KHR_lights_punctual": {"light": 0}}})";
    const Scene scene = load(g, strictly());
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_TRUE(scene.report.forgiven.empty());
    EXPECT_NEAR(scene.lights[0].falloffAngle, 3.14159265, 1e-6);
}

TEST(GltfErrors, OneNodeCostsItself) {
    GltfText g = triangle();
    g.arrays["nodes"].push_back("7");
    expectForgiven(g, "<nodes[1]>: is no object, expected {...}", "it is left out");
    g.arrays["nodes"] = {R"({"mesh": 0})", R"({"children": [1]})"};
    expectForgiven(g, "<nodes[1]>: is on a circle of parents and children", "it is left out");
    g.arrays["nodes"] = {R"({"mesh": 0, "children": [9]})"};
    expectForgiven(g, "<nodes[0].children[0]>: is 9, but there is 1", "it counts as absent");
    g.arrays["nodes"] = {R"({"mesh": 0})", R"({"children": [0]})", R"({"children": [0]})"};
    expectForgiven(g, "<nodes[0]>: is a child of nodes[1] and of nodes[2], expected one parent",
                   "it counts as absent");
}

TEST(GltfErrors, OneTriangleOrPartCostsItself) {
    GltfText g;
    const size_t indices = g.addAccessor<uint8_t>({0, 1, 2, 0, 1, 3}, "SCALAR");
    g.addTriangle(fmt::format(R"(, "indices": {})", indices));
    expectForgiven(g,
                   "<meshes[0].primitives[0].indices>: has the index 3, but there are 3 vertices",
                   "it is left out");
    GltfText parts = triangle();
    parts.arrays["meshes"][0] = R"({"primitives": [{"attributes": {"POSITION": 0}},
        {"attributes": {"POSITION": 0}, "indices": 8}]})";
    expectForgiven(parts, "<meshes[0].primitives[1].indices>: is 8, but there is 1",
                   "it is left out");
}

TEST(GltfErrors, Containers) {
    const std::string whole = triangle().binary();
    EXPECT_EQ(loadGltfBytes(whole).triangles.size(), 1u);
    EXPECT_EQ(gltfProblem(whole.substr(0, 8)),
              "is truncated: the header of a binary file has 12 bytes");
    EXPECT_EQ(gltfProblem(whole.substr(0, whole.size() - 10)),
              fmt::format("is truncated: its header states {} bytes, it has {}", whole.size(),
                          whole.size() - 10));
    std::string other = whole;
    other[4] = 1;
    EXPECT_EQ(gltfProblem(other), "is of version 1 of the binary format, expected 2");
    other = whole;
    other[8] = char(other[8] + 4); // as where a tool has shortened a chunk
    const Scene shorter = loadGltfBytes(other);
    EXPECT_EQ(shorter.triangles.size(), 1u);
    EXPECT_THAT(shorter.report.forgiven, testing::ElementsAre(HasSubstr("its header states")));
    other = whole;
    other[15] = 0x7F;
    EXPECT_THAT(gltfProblem(other), HasSubstr("chunk 0 states 21"));
    other = whole;
    other[16] = 'X';
    EXPECT_EQ(gltfProblem(other), "its first chunk is no JSON");
}

/// Characters by their codes, broken lines, blanks, capitals in words.
TEST(GltfErrors, DataIsReadAsItIsMeant) {
    GltfText g = triangle();
    for (const char* uri :
         {"data:;base64,/+//AA==", "data:;base64,%2F%2B%2f/AA%3D%3D", "data:;base64,/+//\\nAA==\\n",
          "DATA:a/b;BASE64,/+//AA==", "data:a/b; base64 ,/+//AA==", "data:a/b,%01bcd"}) {
        g.arrays["buffers"] = {fmt::format(R"({{"byteLength": 99, "uri": "{}"}})", uri)};
        EXPECT_EQ(problem(g), "<buffers[0].byteLength>: is 99, but there are 4 bytes") << uri;
    }
}

TEST(GltfErrors, Buffers) {
    GltfText g = triangle();
    g.arrays["buffers"] = {R"({"byteLength": 36})"};
    EXPECT_EQ(problem(g), "<buffers[0]>: has no 'uri', and no part of the file holds its bytes");
    g.arrays["buffers"] = {R"({"byteLength": 36, "uri": "data:;base64,AAAA"})"};
    EXPECT_EQ(problem(g), "<buffers[0].byteLength>: is 36, but there are 3 bytes");
    g.arrays["buffers"] = {R"({"byteLength": 36, "uri": "data:;base64,A*AA"})"};
    EXPECT_EQ(problem(g), "<buffers[0]>: the data URI is no base64");
    g.arrays["buffers"] = {R"({"byteLength": 3, "uri": "data:;base64,AAAA"})"};
    EXPECT_EQ(problem(g),
              "<bufferViews[0]>: 36 bytes from 0 on are beyond the 3 bytes of buffers[0]");
}

TEST(GltfErrors, NumbersThatAreNone) {
    // In accessors, where JSON's rules do not reach: the builder leaves such triangles out.
    GltfText g = triangle();
    const size_t bad = g.addAccessor<float>({0, 0, 0, NAN, 0, 0, 0, 1, 0}, "VEC3");
    g.arrays["meshes"][0] =
        fmt::format(R"({{"primitives": [{{"attributes": {{"POSITION": {}}}}}]}})", bad);
    const Scene scene = load(g);
    EXPECT_TRUE(scene.triangles.empty());
    EXPECT_THAT(scene.report.warnings, Contains(HasSubstr("1 not finite or beyond 2^60")));
}

TEST(GltfErrors, AttributesOfOtherLengths) {
    GltfText g;
    const size_t normals = g.addAccessor<float>({0, 0, 1, 0, 0, 1}, "VEC3");
    g.addTriangle("", fmt::format(R"(, "NORMAL": {})", normals));
    expectForgiven(g,
                   "<meshes[0].primitives[0].attributes.NORMAL>: has 2 elements, but there are 3 "
                   "positions",
                   "the mesh is shown without it");
}

/// Damaged files load or say what is wrong; they neither crash nor take the machine's memory.
TEST(GltfErrors, DamagedAnywhere) {
    GltfText g = triangle();
    g.addTo("materials", R"("pbrMetallicRoughness": {"baseColorFactor": [1, 1, 1, 1]})");
    g.addTo("cameras", R"("type": "perspective", "perspective": {"yfov": 1, "znear": 1})");
    const std::string whole = g.binary();
    std::mt19937 random(1);
    for (int i = 0; i < 1000; ++i) {
        std::string damaged = whole;
        for (int k = 0; k < 3; ++k)
            damaged[random() % damaged.size()] =
                char(random() % 2 ? random() : '0' + random() % 10);
        gltfProblem(damaged);
    }
}

TEST(GltfFormat, IsToldByNameAndContent) {
    const Folder folder;
    const GltfText g = triangle();
    for (const char* name : {"a.gltf", "a.GLTF", "a.unknown"})
        EXPECT_EQ(readScene(folder.write(name, g.text()).string()).triangles.size(), 1u) << name;
    for (const char* name : {"a.glb", "b.unknown"})
        EXPECT_EQ(readScene(folder.write(name, g.binary()).string()).triangles.size(), 1u) << name;
}

TEST(GltfFormat, AloneHasScenesAndVariants) {
    SceneConventions conventions;
    conventions.selection.scene = 0;
    try {
        readScene("cornell_boxes", conventions);
        FAIL();
    } catch (const SceneError& error) {
        EXPECT_THAT(error.what(),
                    HasSubstr("cornell_boxes: --scene is about glTF files; this one is COLLADA"));
    }
}

} // namespace
} // namespace stromboli::test
