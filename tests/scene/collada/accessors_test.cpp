// Arrays, accessors, and which input takes which index.

#include "tests/scene/collada/document_text.hpp"

#include "host/core/error.hpp"

namespace stromboli::test {
namespace {

/// A triangle whose positions come through this source "pos".
Scene loadSource(const std::string& source) {
    DocumentText document;
    document.libraries =
        "<library_geometries><geometry id=\"mesh\"><mesh>" + source +
        "<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#pos\"/></vertices>" +
        fmt::format("<triangles count=\"1\">{}<p>0 1 2</p></triangles>", kVertexInput) +
        "</mesh></geometry></library_geometries>";
    document.nodes = meshNode();
    return load(document);
}

std::string source(const std::string& array, const std::string& accessor) {
    return fmt::format("<source id=\"pos\">{}<technique_common>{}</technique_common></source>",
                       array, accessor);
}

TEST(Accessors, OffsetStrideAndUnnamedParams) {
    const Scene scene = loadSource(
        source("<float_array id=\"a\" count=\"17\">9 9 7 0 7 0 0 7 1 7 0 0 7 0 7 1 0</float_array>",
               "<accessor source=\"#a\" count=\"3\" offset=\"2\" stride=\"5\">"
               "<param type=\"float\"/><param name=\"X\" type=\"float\"/><param type=\"float\"/>"
               "<param name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/></accessor>"));
    expectNear(corner(scene, 0, 0), {0, 0, 0});
    expectNear(corner(scene, 0, 1), {1, 0, 0});
    expectNear(corner(scene, 0, 2), {0, 1, 0});
}

TEST(Accessors, WithoutParamsTheValuesAreInOrder) {
    const Scene scene =
        loadSource(source("<float_array id=\"a\" count=\"9\">0 0 0 1 0 0 0 1 0</float_array>",
                          "<accessor source=\"#a\" count=\"3\" stride=\"3\"/>"));
    expectNear(corner(scene, 0, 1), {1, 0, 0});
}

TEST(Accessors, NumbersInAllSpellings) {
    const Scene scene = loadSource(
        source("<float_array id=\"a\" count=\"9\">\t-0 +.5\r\n1e-999<!-- a\n comment -->+1E0 0. "
               "1e-4000 0.0e5 1.e+0 00</float_array>",
               "<accessor source=\"#a\" count=\"3\" stride=\"3\"/>"));
    expectNear(corner(scene, 0, 0), {0, 0.5, 0});
    expectNear(corner(scene, 0, 1), {1, 0, 0});
    expectNear(corner(scene, 0, 2), {0, 1, 0});
}

TEST(Accessors, BadArraysAreErrors) {
    const std::string good = "<accessor source=\"#a\" count=\"3\" stride=\"3\"/>";
    for (const char* numbers :
         {"0 0 0 1 0 0 0 1", "0 0 0 1 0 0 0 1 0 0", "0 0 0 1 0 0 0 1 NaN", "0 0 0 1 0 0 0 1 INF",
          "0 0 0 1 0 0 0 1 -inf", "0 0 0 1 0 0 0 1 1e999", "0 0 0 1 0 0 0 1 x",
          "0 0 0 1 0 0 0 1 1,000.5", "0 0 0 1 0 0 0 1 0x1", "0 0 0 1 0 0 0 1 1,000,5",
          "0 0 0 1 0 0 0 1 1e", "", "0 0 0 1 0 0 0 1 +-1"})
        EXPECT_THROW(loadSource(source(fmt::format("<float_array id=\"a\" count=\"9\">{}"
                                                   "</float_array>",
                                                   numbers),
                                       good)),
                     SceneError)
            << numbers;
    const std::string array = "<float_array id=\"a\" count=\"9\">0 0 0 1 0 0 0 1 0</float_array>";
    for (const char* accessor :
         {"<accessor source=\"#a\" count=\"4\" stride=\"3\"/>",
          "<accessor source=\"#a\" count=\"3\" stride=\"4\"/>",
          "<accessor source=\"#a\" count=\"3\" stride=\"2\"/>",
          "<accessor source=\"#a\" count=\"3\" stride=\"0\"/>",
          "<accessor source=\"#a\" count=\"3\"/>",
          "<accessor source=\"#a\" count=\"3\" offset=\"1\" stride=\"3\"/>",
          "<accessor source=\"#a\" count=\"4294967295\" stride=\"4294967295\" "
          "offset=\"4294967295\"/>",
          "<accessor source=\"#a\" count=\"-1\" stride=\"3\"/>",
          "<accessor source=\"#a\" stride=\"3\"/>", "<accessor source=\"#b\" count=\"3\"/>",
          "<accessor count=\"3\" stride=\"3\"/>", ""})
        EXPECT_THROW(loadSource(source(array, accessor)), SceneError) << accessor;
}

/// Two triangles with inputs VERTEX at 0, NORMAL at `offset`, TEXCOORD at 2.
Scene loadInputs(int normalOffset, const std::string& p) {
    DocumentText document;
    document.libraries = meshLibrary(
        "0 0 0 1 0 0 0 1 0 1 1 0", 12,
        fmt::format("<triangles count=\"2\">{}<input semantic=\"NORMAL\" source=\"#nrm\" "
                    "offset=\"{}\"/><input semantic=\"TEXCOORD\" source=\"#nowhere\" "
                    "offset=\"2\"/><p>{}</p></triangles>",
                    kVertexInput, normalOffset, p),
        floats("nrm", "0 0.6 0.8 0.6 0 0.8 0 0 1 0 -0.6 0.8", 12));
    document.nodes = meshNode();
    return load(document);
}

TEST(Accessors, InputsWithTheirOwnIndices) {
    const Scene scene = loadInputs(1, "0 3 77 1 1 77 2 0 77  1 2 0 3 0 0 2 3 0");
    ASSERT_EQ(scene.triangles.size(), 2u);
    EXPECT_EQ(scene.positions.size(), 4u);
    EXPECT_EQ(scene.normals.size(), 4u);
    expectNear(scene.normals[scene.triangles[0].normals[0]], {0, -0.6, 0.8});
    expectNear(scene.normals[scene.triangles[0].normals[1]], {0.6, 0, 0.8});
    expectNear(scene.normals[scene.triangles[1].normals[1]], {0, 0.6, 0.8});
}

TEST(Accessors, InputsSharingAnIndex) {
    const Scene scene = loadInputs(0, "0 77 77 1 77 77 2 77 77  1 77 0 3 77 0 2 77 0");
    expectNear(scene.normals[scene.triangles[0].normals[0]], {0, 0.6, 0.8});
    expectNear(scene.normals[scene.triangles[1].normals[1]], {0, -0.6, 0.8});
}

TEST(Accessors, NormalsOfVertices) {
    DocumentText document;
    document.libraries =
        "<library_geometries><geometry id=\"mesh\"><mesh>" + floats("pos", "0 0 0 1 0 0 0 1 0", 9) +
        floats("nrm", "0 0.6 0.8 0.6 0 0.8 0 0 1", 9) +
        "<vertices id=\"v\"><input semantic=\"NORMAL\" source=\"#nrm\"/>"
        "<input semantic=\"POSITION\" source=\"#pos\"/></vertices>" +
        fmt::format("<triangles count=\"1\">{}<p>2 0 1</p></triangles>", kVertexInput) +
        "</mesh></geometry></library_geometries>";
    document.nodes = meshNode();
    const Scene scene = load(document);
    expectNear(scene.normals[scene.triangles[0].normals[0]], {0, 0, 1});
    expectNear(scene.normals[scene.triangles[0].normals[2]], {0.6, 0, 0.8});
}

} // namespace
} // namespace stromboli::test
