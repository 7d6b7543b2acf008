// Skins and morphs stand in their rest pose.

#include "tests/scene/collada/document_text.hpp"

#include "host/core/error.hpp"

namespace stromboli::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::MatchesRegex;

struct SkinText {
    std::string source = "#mesh";
    std::string bindShape = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1";
    std::string names = "<Name_array id=\"n\" count=\"2\"> hip  knee</Name_array>";
    /// Weights of the first joint and a second one.
    std::string inverseBind = "1 0 0 -10 0 1 0 0 0 0 1 0 0 0 0 1  1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1";
    std::string joints = "<joints><input semantic=\"JOINT\" source=\"#names\"/><input "
                         "semantic=\"INV_BIND_MATRIX\" source=\"#matrices\"/></joints>";

    std::string str() const {
        return fmt::format("<controller id=\"skin\"><skin source=\"{}\"><bind_shape_matrix>{}"
                           "</bind_shape_matrix><source id=\"names\">{}</source><source "
                           "id=\"matrices\"><float_array id=\"m\" count=\"32\">{}</float_array>"
                           "</source>{}</skin></controller>",
                           source, bindShape, names, inverseBind, joints);
    }
};

/// The bone of the first joint stands at x = 12 in a node that is moved up by 3; the node that
/// shows the skin stands elsewhere, which does not matter.
Scene loadSkin(const std::string& controllers, const std::string& skeleton = "#root") {
    DocumentText document;
    document.libraries =
        triangleLibrary() + "<library_controllers>" + controllers + "</library_controllers>";
    document.nodes =
        "<node id=\"root\"><translate>0 3 0</translate><node id=\"hipId\" sid=\"hip\" "
        "type=\"JOINT\"><translate>12 0 0</translate><node sid=\"knee\"/></node></node>"
        "<node><translate>0 0 100</translate><instance_controller url=\"#skin\"><skeleton>" +
        skeleton + "</skeleton></instance_controller></node>";
    return load(document);
}

TEST(Controllers, ASkinStandsWhereItsFirstJointDoes) {
    const Scene scene = loadSkin(SkinText{}.str());
    ASSERT_EQ(scene.triangles.size(), 1u);
    // 10 to the left to the joint's own place, 12 to the right with it, 3 up with its parent.
    expectNear(corner(scene, 0, 0), {2, 3, 0});
    expectNear(corner(scene, 0, 1), {3, 3, 0});
    EXPECT_THAT(scene.report.ignored, Contains("1 <skin>: its rest pose is shown"));
    EXPECT_THAT(scene.report.forgiven, testing::IsEmpty());
}

TEST(Controllers, TheShapeIsBoundByItsMatrix) {
    SkinText skin;
    skin.bindShape = "2 0 0 0 0 2 0 0 0 0 2 7 0 0 0 1";
    const Scene scene = loadSkin(skin.str());
    expectNear(corner(scene, 0, 0), {2, 3, 7});
    expectNear(corner(scene, 0, 1), {4, 3, 7});
}

/// A node's own transformation is applied before those of the nodes that it is in.
TEST(Controllers, AJointMovesWithTheNodesThatItIsIn) {
    DocumentText document;
    SkinText skin;
    skin.inverseBind = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1  1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1";
    document.asset = "<unit meter=\"10\"/>";
    document.libraries =
        triangleLibrary() + "<library_controllers>" + skin.str() + "</library_controllers>";
    document.nodes = "<node><rotate>0 0 1 90</rotate><node sid=\"hip\"><translate>2 0 0</translate>"
                     "</node></node><node><instance_controller url=\"#skin\"/></node>";
    const Scene scene = load(document);
    expectNear(corner(scene, 0, 0), {0, 20, 0}, 1e-5);
    expectNear(corner(scene, 0, 1), {0, 30, 0}, 1e-5);
}

TEST(Controllers, JointsAreFoundByIdOrAnywhereInTheScene) {
    SkinText skin;
    skin.names = "<IDREF_array id=\"n\" count=\"1\">hipId</IDREF_array>";
    expectNear(corner(loadSkin(skin.str()), 0, 0), {2, 3, 0});
    expectNear(corner(loadSkin(SkinText{}.str(), "#gone"), 0, 0), {2, 3, 0});
}

/// Two skeletons whose joints have the same sids: each instance says which is its own.
TEST(Controllers, JointsAreThoseOfTheSkeletonNamed) {
    DocumentText document;
    SkinText skin;
    skin.inverseBind = "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1  1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1";
    document.libraries =
        triangleLibrary() + "<library_controllers>" + skin.str() + "</library_controllers>";
    for (int i = 0; i < 4; ++i)
        document.nodes += fmt::format("<node id=\"root{0}\"><translate>{0} 0 0</translate><node/>"
                                      "<node sid=\"hip\"><translate>0 {0} 0</translate></node>"
                                      "</node>",
                                      i);
    for (const int i : {2, 0, 3, 1})
        document.nodes += fmt::format("<node><instance_controller url=\"#skin\"><skeleton>#root{}"
                                      "</skeleton></instance_controller></node>",
                                      i);
    const Scene scene = load(document);
    ASSERT_EQ(scene.triangles.size(), 4u);
    size_t triangle = 0;
    for (const int i : {2, 0, 3, 1})
        expectNear(corner(scene, triangle++, 0), {i, i, 0});
}

TEST(Controllers, WithoutItsJointASkinStandsInItsNode) {
    SkinText noJoint, noMatrix, noInputs;
    noJoint.names = "<Name_array id=\"n\" count=\"1\">elbow</Name_array>";
    noMatrix.inverseBind = "1 0 0";
    noInputs.joints = "";
    for (const SkinText& skin : {noJoint, noMatrix, noInputs}) {
        const Scene scene = loadSkin(skin.str());
        expectNear(corner(scene, 0, 0), {0, 0, 100});
        EXPECT_THAT(scene.report.forgiven,
                    ElementsAre(MatchesRegex(".*<skin>: its first joint.*")));
    }
}

TEST(Controllers, AMorphIsItsBaseMesh) {
    const Scene scene = loadSkin("<controller id=\"skin\"><morph source=\"#mesh\"/></controller>");
    ASSERT_EQ(scene.triangles.size(), 1u);
    expectNear(corner(scene, 0, 0), {0, 0, 100});
    EXPECT_THAT(scene.report.ignored, Contains("1 <morph>: its rest pose is shown"));
}

TEST(Controllers, ASkinCanBeThatOfAMorph) {
    SkinText skin;
    skin.source = "#morph";
    const Scene scene =
        loadSkin(skin.str() + "<controller id=\"morph\"><morph source=\"#mesh\"/></controller>");
    ASSERT_EQ(scene.triangles.size(), 1u);
    expectNear(corner(scene, 0, 0), {2, 3, 0});
}

TEST(Controllers, BadOnes) {
    const Scene empty = loadSkin("<controller id=\"skin\"/>");
    EXPECT_TRUE(empty.triangles.empty());
    EXPECT_THAT(empty.report.forgiven, ElementsAre(HasSubstr("neither <skin> nor <morph>")));
    const auto error = [](const std::string& controllers) -> std::string {
        try {
            loadSkin(controllers);
        } catch (const SceneError& e) {
            return e.what();
        }
        return "no error";
    };
    EXPECT_THAT(error(""), HasSubstr("no <controller> with this id"));
    SkinText self, gone;
    self.source = "#skin", gone.source = "#gone";
    EXPECT_THAT(error(self.str()), HasSubstr("contains itself"));
    EXPECT_THAT(error(gone.str()), HasSubstr("no <controller> with this id"));
    SkinText short_;
    short_.bindShape = "1 0 0";
    EXPECT_THAT(error(short_.str()), HasSubstr("expected 16"));
}

} // namespace
} // namespace stromboli::test
