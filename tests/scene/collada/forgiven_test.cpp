// What breaks the standard and is read all the same: each with a line that says so, and an error
// where nothing is forgiven.

#include "tests/scene/collada/document_text.hpp"

#include "host/core/error.hpp"

namespace stromboli::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::MatchesRegex;

SceneConventions strict() {
    SceneConventions conventions;
    conventions.strict = true;
    return conventions;
}

/// Loads a document of which one thing is forgiven; `line`: a regular expression that begins with
/// the number of the line. The strict reading must be the error of the same words.
Scene forgiven(const std::string& text, const std::string& line) {
    const Scene scene = loadText(text);
    EXPECT_THAT(scene.report.forgiven, ElementsAre(MatchesRegex(".*\\.dae:" + line)));
    try {
        loadText(text, strict());
        ADD_FAILURE() << "not an error: " << line;
    } catch (const SceneError& error) {
        EXPECT_THAT(error.what(), MatchesRegex(".*\\.dae:[0-9]+: .*because of --strict."));
    }
    return scene;
}

Scene forgiven(const DocumentText& document, const std::string& line) {
    return forgiven(document.str(), line);
}

/// Shows a triangle whose material is described by a library.
DocumentText withMaterial(const std::string& libraries) {
    DocumentText document;
    document.libraries =
        libraries + meshLibrary("0 0 0 1 0 0 0 1 0", 9,
                                fmt::format("<triangles material=\"M\" count=\"1\">{}<p>0 1 2</p>"
                                            "</triangles>",
                                            kVertexInput));
    document.nodes = "<node><instance_geometry url=\"#mesh\"><bind_material><technique_common>\n"
                     "<instance_material symbol=\"M\" target=\"#m\"/></technique_common>"
                     "</bind_material></instance_geometry></node>";
    return document;
}

std::string effectLibrary(const std::string& profile) {
    return "<library_materials><material id=\"m\" name=\"Mat\"><instance_effect url=\"#e\"/>"
           "</material></library_materials><library_effects><effect id=\"e\">" +
           profile + "</effect></library_effects>";
}

void expectGrey(const Scene& scene) {
    ASSERT_EQ(scene.triangles.size(), 1u);
    EXPECT_EQ(scene.materials.at(scene.triangles[0].material).albedo, glm::vec3(0.5f));
}

TEST(Forgiven, NothingInADocumentThatKeepsTheRules) {
    DocumentText document;
    document.libraries = triangleLibrary();
    document.nodes = meshNode();
    EXPECT_THAT(load(document).report.forgiven, IsEmpty());
    EXPECT_EQ(loadText(document.str(), strict()).triangles.size(), 1u);
}

TEST(Forgiven, OnePartOfAMeshCostsItself) {
    DocumentText document;
    document.libraries =
        meshLibrary("0 0 0 1 0 0 0 1 0", 9,
                    fmt::format("<triangles count=\"1\">{}<p>0 1 2</p></triangles>"
                                "<triangles count=\"2\">{}<p>0 1 2 0 1 7</p></triangles>",
                                kVertexInput, kVertexInput));
    document.nodes = meshNode();
    const Scene scene = forgiven(document, "[0-9]+: .*position index 7 is out of range: there are "
                                           "3: it is left out");
    EXPECT_EQ(scene.triangles.size(), 1u);
}

/// One thing of a node, beside a mesh that is shown.
TEST(Forgiven, WhatANodeCannotShowCostsItself) {
    const std::pair<std::string, std::string> cases[] = {
        {"<instance_camera url=\"#bad\"/>",
         ".*<perspective>: has neither <xfov> nor <yfov>: it is left out"},
        {"<instance_light url=\"#bad\"/>",
         ".*<point>: has no <color>, which is required: it is left out"},
        {"<instance_geometry url=\"#gone\"/>", ".*no <geometry> with this id: it is left out"},
        {"<instance_node url=\"#gone\"/>", ".*no <node> with this id: it is left out"},
        {"<node><rotate>1 2</rotate></node>",
         ".*<rotate>: has 2 numbers, expected 4: it has no effect"},
        {"<node id=\"n\"><instance_node url=\"#n\"/></node>",
         ".*contains itself.*: it is left out"},
    };
    for (const auto& [child, line] : cases) {
        DocumentText document;
        document.libraries =
            "<library_cameras><camera id=\"bad\"><optics><technique_common><perspective/>"
            "</technique_common></optics></camera></library_cameras><library_lights>"
            "<light id=\"bad\"><technique_common><point/></technique_common></light>"
            "</library_lights>" +
            triangleLibrary();
        document.nodes = "<node>" + child + "</node>" + meshNode();
        const Scene scene = forgiven(document, "[0-9]+: " + line);
        EXPECT_EQ(scene.triangles.size(), 1u) << child;
    }
}

/// The second instance of a mesh that cannot be read is not another mesh.
TEST(Forgiven, AMeshThatCannotBeReadIsLeftOutEachTime) {
    DocumentText document;
    document.libraries = triangleLibrary();
    std::string bad = meshLibrary("0 0 0 1 0 0 0 1 0", 9, "<triangles count=\"x\"/>");
    for (size_t at = bad.find("\"mesh\""); at != std::string::npos; at = bad.find("\"mesh\""))
        bad.replace(at, 6, "\"bad\"");
    document.libraries += bad;
    document.nodes = meshNode() + "<node><instance_geometry url=\"#bad\"/></node>"
                                  "<node><instance_geometry url=\"#bad\"/></node>";
    EXPECT_EQ(load(document).triangles.size(), 1u);
}

TEST(Forgiven, DecimalCommas) {
    DocumentText document;
    document.asset = "<unit meter=\"0,5\"/>";
    document.libraries =
        meshLibrary("0 0 0 1,5 0 0 0 -2,5e-1 ,5", 9,
                    fmt::format("<triangles count=\"1\">{}<p>0 1 2</p></triangles>", kVertexInput));
    document.nodes = meshNode();
    const Scene scene =
        forgiven(document, "3: <unit>: has decimal commas: they are read as points \\(2 times\\)");
    expectNear(corner(scene, 0, 1), {0.75, 0, 0});
    expectNear(corner(scene, 0, 2), {0, -0.125, 0.25});
}

TEST(Forgiven, ReferencesWithoutAMark) {
    DocumentText document;
    document.libraries = triangleLibrary();
    document.nodes = "<node><instance_geometry url=\"mesh\"/></node>";
    const Scene scene =
        forgiven(document, "[0-9]+: <instance_geometry>: url=\"mesh\" has no '#': the element .*");
    EXPECT_EQ(scene.triangles.size(), 1u);
}

TEST(Forgiven, ReferencesMayNameTheirOwnFile) {
    DocumentText document;
    document.libraries = triangleLibrary();
    document.nodes = "<node><instance_geometry url=\"./own%20name.dae#mesh\"/></node>";
    const std::filesystem::path file =
        std::filesystem::path(testing::TempDir()) / std::to_string(getpid()) / "own name.dae";
    std::filesystem::create_directory(file.parent_path());
    std::ofstream(file) << document.str();
    EXPECT_EQ(loadCollada(file, strict()).triangles.size(), 1u);
    std::filesystem::remove_all(file.parent_path());
}

TEST(Forgiven, MaterialsThatAreNotThere) {
    expectGrey(forgiven(withMaterial(""), "7: <instance_material>: target=\"#m\": the file has no "
                                          "<material> with this id: mid grey .*"));
    expectGrey(forgiven(withMaterial("<library_materials><material id=\"m\"/></library_materials>"),
                        "4: <material>: has no <instance_effect>: mid grey .*"));
    expectGrey(forgiven(withMaterial("<library_materials><material id=\"m\"><instance_effect "
                                     "url=\"other.dae#e\"/></material></library_materials>"),
                        "4: <instance_effect>: url=.* refers to another file.*: mid grey .*"));
}

TEST(Forgiven, EffectsThatSayNothing) {
    const char* const none = "has none of <constant>, <lambert>, <phong>, <blinn>: mid grey .*";
    expectGrey(forgiven(withMaterial(effectLibrary("<profile_COMMON/>")),
                        fmt::format("4: <profile_COMMON>: {}", none)));
    expectGrey(
        forgiven(withMaterial(effectLibrary("<profile_COMMON><technique/></profile_COMMON>")),
                 fmt::format("4: <technique>: {}", none)));
    const auto phong = [](const char* diffuse) {
        return withMaterial(effectLibrary(fmt::format(
            "<profile_COMMON><technique><phong><emission><color>1 2 3</color></emission><diffuse>"
            "{}</diffuse></phong></technique></profile_COMMON>",
            diffuse)));
    };
    for (const auto& [diffuse, line] :
         {std::pair{"", "4: <diffuse>: has neither <color> nor .*"},
          std::pair{"<param ref=\"d\"/>",
                    "4: <param>: ref=\"d\": the effect has no <newparam> .*"}}) {
        const Scene scene = forgiven(phong(diffuse), line);
        EXPECT_EQ(scene.materials.at(0).albedo, glm::vec3(0));
        EXPECT_EQ(scene.materials.at(0).emission, glm::vec3(1, 2, 3));
    }
}

TEST(Forgiven, MaterialsThatAreBoundByNothing) {
    DocumentText document;
    document.libraries = triangleLibrary();
    document.nodes = "<node><instance_geometry url=\"#mesh\"><bind_material/></instance_geometry>"
                     "</node>";
    expectGrey(forgiven(document, "6: <bind_material>: has no <technique_common>: .*"));
}

TEST(Forgiven, CamerasThatAreNotThere) {
    DocumentText document;
    document.nodes = "<node><instance_camera url=\"#c\"/></node>";
    const auto cameras = [&](const char* library, const char* line) {
        document.libraries = library;
        return forgiven(document, line).cameras.size();
    };
    EXPECT_EQ(cameras("", "6: <instance_camera>: url=\"#c\": the file has no <camera> .*left out"),
              0u);
    for (const char* content : {"", "<optics/>", "<optics><technique_common/></optics>"})
        EXPECT_EQ(cameras(fmt::format("<library_cameras><camera id=\"c\">{}</camera>"
                                      "</library_cameras>",
                                      content)
                              .c_str(),
                          "4: <camera>: 'c' has no <optics> .*left out"),
                  0u);
}

TEST(Forgiven, LightsThatAreNotThere) {
    DocumentText document;
    document.nodes = "<node><instance_light url=\"#l\"/></node>";
    const auto lights = [&](const std::string& library, const char* line) {
        document.libraries = library;
        return forgiven(document, line).lights.size();
    };
    EXPECT_EQ(lights("", "6: <instance_light>: url=\"#l\": the file has no <light> .*left out"),
              0u);
    for (const char* content : {"", "<technique_common/>",
                                "<technique_common><laser><color>1 1 1</color></laser>"
                                "</technique_common>"})
        EXPECT_EQ(lights(fmt::format("<library_lights><light id=\"l\">{}</light></library_lights>",
                                     content),
                         "4: <light>: 'l' has no <technique_common> with .*left out"),
                  0u);
}

TEST(Forgiven, IdsThatAreThereTwice) {
    DocumentText document;
    document.nodes = "<node><instance_light url=\"#l\"/></node>";
    const auto color = [&](const std::string& lights) {
        document.libraries = "<library_lights>" + lights + "</library_lights>";
        return forgiven(document, "4: <light>: the id 'l' is there already: .*").lights.at(0).color;
    };
    const auto light = [](int value) {
        return fmt::format("<light id=\"l\"><technique_common><point><color>{0} {0} {0}</color>"
                           "</point></technique_common></light>",
                           value);
    };
    EXPECT_EQ(color(light(1) + light(2)), glm::vec3(1));
    EXPECT_EQ(color("<light id=\"l\"/>" + light(2)), glm::vec3(2)) << "an empty one does not count";
}

TEST(Forgiven, DocumentsThatDoNotSayWhatIsShown) {
    DocumentText document;
    document.libraries = triangleLibrary();
    document.nodes = meshNode();
    const std::string text = document.str();
    const size_t begin = text.find("<scene>"), end = text.find("</COLLADA>");
    EXPECT_EQ(forgiven(text.substr(0, begin) + text.substr(end),
                       "2: <COLLADA>: no <instance_visual_scene> .*")
                  .triangles.size(),
              1u);
    EXPECT_EQ(forgiven(text.substr(0, begin) + "<scene/>" + text.substr(end),
                       "8: <scene>: no <instance_visual_scene> .*")
                  .triangles.size(),
              1u);
}

TEST(Forgiven, Utf16WithoutAMark) {
    DocumentText document;
    document.libraries = triangleLibrary();
    document.nodes = meshNode();
    std::string text;
    for (const char c : document.str())
        text += std::string{c, '\0'};
    EXPECT_EQ(
        forgiven(text, "1: the text is UTF-16 without a byte order mark: .*").triangles.size(), 1u);
    EXPECT_THAT(loadText("\xFF\xFE" + text, strict()).report.forgiven, IsEmpty());
}

/// Flat shading needs no normals, and the standard asks for none.
TEST(Forgiven, MeshesWithoutNormalsAreNoFault) {
    DocumentText document;
    document.libraries = triangleLibrary();
    document.nodes = meshNode();
    const Scene scene = loadText(document.str(), strict());
    EXPECT_THAT(scene.report.assumed,
                testing::Contains(HasSubstr("a mesh without normals is shaded flat")));
}

TEST(Forgiven, OtherInputsOfCornersAreIgnoredWhichIsNoFaultEither) {
    DocumentText document;
    document.libraries = meshLibrary(
        "0 0 0 1 0 0 0 1 0", 9,
        fmt::format("<triangles count=\"1\">{}<input semantic=\"TEXBINORMAL\" source=\"#pos\" "
                    "offset=\"1\"/><p>0 0 1 1 2 2</p></triangles>",
                    kVertexInput));
    document.nodes = meshNode();
    EXPECT_THAT(loadText(document.str(), strict()).report.ignored,
                testing::Contains(HasSubstr("TEXBINORMAL")));
}

} // namespace
} // namespace stromboli::test
