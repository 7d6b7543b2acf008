// Nothing is ignored in silence.

#include "tests/scene/collada/document_text.hpp"

namespace stromboli::test {
namespace {

using testing::Contains;
using testing::HasSubstr;
using testing::IsEmpty;

TEST(Report, CountsPerKind) {
    DocumentText document;
    document.libraries =
        "<library_animations><animation/><animation/><extra/></library_animations>"
        "<library_controllers><controller id=\"s\"><morph source=\"#mesh\"/></controller>"
        "</library_controllers>"
        "<library_images><image/></library_images><library_physics_scenes/>" +
        meshLibrary("0 0 0 1 0 0 0 1 0", 9,
                    fmt::format("<lines count=\"1\"/><linestrips count=\"1\"/>"
                                "<triangles count=\"1\">{}<input semantic=\"TEXCOORD\" "
                                "source=\"#x\" offset=\"1\"/><p>0 0 1 0 2 0</p></triangles>",
                                kVertexInput));
    document.nodes = meshNode() + "<node><instance_controller url=\"#s\"/></node>"
                                  "<node><instance_controller url=\"#s\"/></node>"
                                  "<evaluate_scene/>";
    const auto ignored = load(document).report.ignored;
    for (const char* line :
         {"2 <animation>:", "1 <lines>:", "1 <linestrips>:", "1 <input semantic=\"TEXCOORD\">:",
          "2 <morph>: its rest pose", "1 <evaluate_scene>:"})
        EXPECT_THAT(ignored, Contains(testing::StartsWith(line)));
    EXPECT_EQ(ignored.size(), 6u);
}

TEST(Report, MetadataIsSilent) {
    DocumentText document;
    document.asset = "<contributor><author>me</author></contributor><created>2026</created>";
    document.libraries = "<extra><technique profile=\"blender\"><x/></technique></extra>"
                         "<library_lights><extra/></library_lights><library_images/>";
    document.nodes = "<asset/><node layer=\"L1\" type=\"JOINT\"><asset/><extra><technique "
                     "profile=\"blender\"><matrix>x</matrix></technique></extra></node><extra/>";
    const Scene scene = load(document);
    EXPECT_THAT(scene.report.ignored, IsEmpty());
    EXPECT_THAT(scene.report.warnings, IsEmpty());
}

TEST(Report, SceneAndMaterialDetails) {
    DocumentText document;
    document.libraries =
        "<library_effects><effect id=\"e\"><profile_COMMON><technique><lambert/></technique>"
        "</profile_COMMON></effect></library_effects><library_materials><material id=\"m\">"
        "<instance_effect url=\"#e\"><setparam ref=\"x\"/></instance_effect></material>"
        "</library_materials>" +
        triangleLibrary();
    document.nodes = "<node><instance_geometry url=\"#mesh\"><bind_material><technique_common>"
                     "<instance_material symbol=\"M\" target=\"#m\"><bind "
                     "semantic=\"UV\"/></instance_material></technique_common></bind_material>"
                     "</instance_geometry></node>";
    const auto ignored = load(document).report.ignored;
    EXPECT_THAT(ignored, Contains(HasSubstr("1 <setparam>")));
    EXPECT_THAT(ignored, Contains(HasSubstr("1 <bind>")));
    std::string text = document.str();
    text.insert(text.find("</scene>"), "<instance_physics_scene url=\"#p\"/>");
    EXPECT_THAT(loadText(text).report.ignored, Contains(HasSubstr("1 <instance_physics_scene>")));
}

TEST(Report, OtherGeometries) {
    DocumentText document;
    document.libraries = "<library_geometries><geometry id=\"mesh\"><spline/></geometry>"
                         "</library_geometries>";
    document.nodes = meshNode();
    const Scene scene = load(document);
    EXPECT_THAT(scene.report.ignored, Contains(HasSubstr("1 <spline>")));
    EXPECT_THAT(scene.report.warnings, Contains(HasSubstr("no triangles")));
}

} // namespace
} // namespace stromboli::test
