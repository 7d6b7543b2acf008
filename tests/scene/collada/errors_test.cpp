// Documents that are no documents, and references that lead nowhere.

#include "tests/scene/collada/document_text.hpp"

#include "host/core/error.hpp"

namespace stromboli::test {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::MatchesRegex;
using testing::ThrowsMessage;

TEST(Errors, FilesThatCannotBeRead) {
    EXPECT_THAT(
        [] { loadCollada("/nowhere/scene.dae"); },
        ThrowsMessage<SceneError>(AllOf(HasSubstr("/nowhere/scene.dae"),
                                        HasSubstr("cannot be opened"), HasSubstr("No such file"))));
    EXPECT_THAT([] { loadCollada(testing::TempDir()); },
                ThrowsMessage<SceneError>(HasSubstr("is a directory")));
}

TEST(Errors, TextThatIsNotCollada) {
    EXPECT_THAT(errorOf(std::string()), HasSubstr("empty"));
    EXPECT_THAT(errorOf(" \n"), HasSubstr("empty"));
    EXPECT_THAT(errorOf("<?xml version=\"1.0\"?>\n<!-- nothing -->"), HasSubstr("no elements"));
    EXPECT_THAT(errorOf("<scenery>\n</scenery>"),
                MatchesRegex(".*:1: <scenery>: .*must be <COLLADA>"));
    EXPECT_THAT(errorOf("<COLLADA>\n<a>\n</b></COLLADA>"),
                MatchesRegex(".*:[23]: not well-formed XML: .*"));
    EXPECT_THAT(errorOf("<COLLADA/>"), HasSubstr("has no <scene>"));
}

TEST(Errors, EveryTruncationIsFound) {
    DocumentText document;
    document.libraries = triangleLibrary();
    document.nodes = meshNode();
    const std::string text = document.str();
    ASSERT_EQ(errorOf(text), "no error");
    const size_t last = text.rfind('>');
    for (size_t length = 0; length < last; ++length)
        ASSERT_NE(errorOf(text.substr(0, length)), "no error") << length;
}

TEST(Errors, ExcessiveNesting) {
    std::string open, close;
    for (int i = 0; i < 100000; ++i)
        open += "<node>", close += "</node>";
    EXPECT_THAT(errorOf("<COLLADA>" + open + close + "</COLLADA>"), HasSubstr("nested more than"));
}

TEST(Errors, NameFileLineAndElement) {
    DocumentText document;
    document.nodes = "<node>\n\n<instance_geometry url=\"#Hemi-mesh\"/></node>";
    EXPECT_THAT(errorOf(document),
                MatchesRegex(".*\\.dae:8: <instance_geometry>: url=\"#Hemi-mesh\": the file has "
                             "no <geometry> with this id"));
}

TEST(Errors, References) {
    const auto error = [](const std::string& child) {
        DocumentText document;
        document.libraries = triangleLibrary();
        document.nodes = "<node id=\"n\">" + child + "</node>";
        return errorOf(document);
    };
    EXPECT_THAT(error("<instance_geometry url=\"#gone\"/>"), HasSubstr("no <geometry>"));
    EXPECT_THAT(error("<instance_geometry url=\"#n\"/>"), HasSubstr("no <geometry>"));
    EXPECT_THAT(error("<instance_geometry/>"), HasSubstr("no attribute 'url'"));
    EXPECT_THAT(error("<instance_geometry url=\"gone\"/>"), HasSubstr("written as #id"));
    EXPECT_THAT(error("<instance_geometry url=\"\"/>"), HasSubstr("written as #id"));
    EXPECT_THAT(error("<instance_geometry url=\"#\"/>"), HasSubstr("no <geometry>"));
    EXPECT_THAT(error("<instance_geometry url=\"other.dae#mesh\"/>"), HasSubstr("another file"));
    EXPECT_THAT(error("<instance_node url=\"#gone\"/>"), HasSubstr("no <node>"));
    EXPECT_EQ(error("<instance_geometry url=\"#mes%68\"/>"), "no error");
    const auto bound = [&](const std::string& attributes) {
        return error("<instance_geometry url=\"#mesh\"><bind_material><technique_common>"
                     "<instance_material " +
                     attributes + "/></technique_common></bind_material></instance_geometry>");
    };
    EXPECT_THAT(bound("symbol=\"a\""), HasSubstr("no attribute 'target'"));
}

TEST(Errors, MissingParts) {
    EXPECT_THAT(errorOf("<COLLADA><scene/></COLLADA>"), HasSubstr("<instance_visual_scene>"));
    EXPECT_THAT(errorOf("<COLLADA><scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>"),
                HasSubstr("no <visual_scene>"));
    DocumentText document;
    document.nodes = meshNode();
    const auto withMesh = [&](const std::string& mesh) {
        document.libraries = "<library_geometries><geometry id=\"mesh\"><mesh>" + mesh +
                             "</mesh></geometry></library_geometries>";
        return errorOf(document);
    };
    EXPECT_THAT(withMesh(""), HasSubstr("has no <vertices>"));
    EXPECT_THAT(withMesh("<vertices id=\"v\"/>"), HasSubstr("POSITION"));
    EXPECT_THAT(withMesh("<vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/>"
                         "</vertices>"),
                HasSubstr("no <source>"));
}

TEST(Errors, NothingToSeeIsNoError) {
    const Scene scene = load(DocumentText{});
    EXPECT_TRUE(scene.triangles.empty() && scene.lights.empty() && scene.cameras.empty());
}

} // namespace
} // namespace stromboli::test
