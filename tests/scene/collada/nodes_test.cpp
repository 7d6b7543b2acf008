// Transformations, hierarchies and the document's axes and unit.

#include "tests/scene/collada/document_text.hpp"

#include "host/core/error.hpp"

#include <cmath>

namespace stromboli::test {
namespace {

using testing::HasSubstr;
using testing::ThrowsMessage;

/// Where a node's transformations take the point (1, 2, 3).
glm::vec3 transformed(const std::string& transforms, const std::string& asset = "") {
    DocumentText document;
    document.asset = asset;
    document.libraries =
        meshLibrary("1 2 3 9 2 3 1 9 3", 9,
                    fmt::format("<triangles count=\"1\">{}<p>0 1 2</p></triangles>", kVertexInput));
    document.nodes = meshNode(transforms);
    const Scene scene = load(document);
    // The first position used: mirroring keeps corner 0.
    return corner(scene, 0, 0);
}

TEST(Nodes, MatrixIsRowMajor) {
    expectNear(transformed("<matrix>1 0 0 10 0 2 0 20 0 0 3 30 0 0 0 1</matrix>"), {11, 24, 39});
}

TEST(Nodes, SingleTransformations) {
    expectNear(transformed("<translate>10 20 30</translate>"), {11, 22, 33});
    expectNear(transformed("<scale>2 3 4</scale>"), {2, 6, 12});
    expectNear(transformed("<rotate>0 0 1 90</rotate>"), {-2, 1, 3});
    expectNear(transformed("<rotate>0 0 -5 90</rotate>"), {2, -1, 3});
    expectNear(transformed("<rotate>0 0 0 0</rotate>"), {1, 2, 3});
}

TEST(Nodes, LookatPutsMinusZTowardsTheInterest) {
    // Eye at (5, 0, 0), looking along -x: right = -z, back = +x.
    expectNear(transformed("<lookat>5 0 0  0 0 0  0 1 0</lookat>"), {5 + 3, 2, -1});
}

TEST(Nodes, SkewShearsAlongTheSecondAxis) {
    // The example of the standard: along x, by 45 degrees from y.
    expectNear(transformed("<skew>45 0 1 0 1 0 0</skew>"), {1 + 2, 2, 3});
    expectNear(transformed("<skew>30 0 0 1 0 1 0</skew>"), {1, 2 + 3 * std::tan(M_PI / 6), 3});
    // Axes at 45 degrees: (1, 1, 0) turns by 15 degrees towards x and keeps its y; x stays.
    const double shift = 1 / std::tan(M_PI / 6) - 1;
    expectNear(transformed("<skew>15 1 1 0 1 0 0</skew>"), {1 + 2 * shift, 2, 3});
}

TEST(Nodes, StackAppliesInDocumentOrder) {
    expectNear(transformed("<translate>10 0 0</translate><rotate>0 0 1 90</rotate>"
                           "<scale>2 2 2</scale><translate>1 0 0</translate>"),
               {10 - 4, 4, 6});
}

TEST(Nodes, ChildrenAndInstancedNodesInherit) {
    DocumentText document;
    document.libraries = triangleLibrary() +
                         "<library_nodes><node id=\"L\"><translate>0 0 5</translate>"
                         "<instance_geometry url=\"#mesh\"/></node></library_nodes>";
    document.nodes = "<node><scale>2 2 2</scale><translate>1 0 0</translate>"
                     "<node><translate>0 1 0</translate>"
                     "<instance_geometry url=\"#mesh\"/><instance_geometry url=\"#mesh\"/></node>"
                     "<instance_node url=\"#L\"/><instance_node url=\"#L\"/></node>";
    const Scene scene = load(document);
    ASSERT_EQ(scene.triangles.size(), 4u);
    EXPECT_EQ(scene.instances.size(), 4u);
    for (size_t i = 0; i < 4; ++i)
        EXPECT_EQ(scene.triangles[i].instance, i);
    expectNear(corner(scene, 0, 0), {2, 2, 0});
    expectNear(corner(scene, 1, 1), {4, 2, 0});
    expectNear(corner(scene, 2, 0), {2, 0, 10});
    expectNear(corner(scene, 3, 2), {2, 2, 10});
}

TEST(Nodes, UpAxisAndUnit) {
    expectNear(transformed("", ""), {1, 2, 3});
    expectNear(transformed("", "<up_axis>Y_UP</up_axis>"), {1, 2, 3});
    expectNear(transformed("", "<up_axis> Z_UP\n</up_axis>"), {-1, 3, 2});
    expectNear(transformed("", "<up_axis>X_UP</up_axis>"), {2, 1, -3});
    expectNear(transformed("", "<unit name=\"centimeter\" meter=\"0.01\"/>"), {.01, .02, .03});
    // What makes no sense has no effect.
    for (const char* bad : {"<up_axis>W_UP</up_axis>", "<unit meter=\"0\"/>",
                            "<unit meter=\"-1\"/>", "<unit meter=\"NaN\"/>"})
        expectNear(transformed("", bad), {1, 2, 3});
}

TEST(Nodes, TransformationsThatMakeNoSenseHaveNoEffect) {
    for (const char* bad : {"<matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0</matrix>",   // 15 numbers
                            "<matrix>1 0 0 0 0 1 0 0 0 0 1 0 5 6 7 1</matrix>", // column-major
                            "<rotate>0 0 0 90</rotate>",                        // no axis
                            "<lookat>1 1 1 1 1 1 0 1 0</lookat>",               // no line of sight
                            "<lookat>0 0 0 0 1 0 0 1 0</lookat>",               // up along it
                            "<skew>90 0 1 0 1 0 0</skew>",                      // infinite shear
                            "<skew>10 1 0 0 1 0 0</skew>",                      // parallel axes
                            "<translate>1 2</translate>", "<scale>1 2 3 4</scale>"})
        expectNear(transformed(bad + std::string("<translate>1 0 0</translate>")), {2, 2, 3});
    // One that overflows leaves nothing of its node, and here of the scene.
    EXPECT_THROW(transformed("<scale>1e300 1 1</scale><scale>1e300 1 1</scale>"), SceneError);
}

TEST(Nodes, CyclesAreErrors) {
    DocumentText document;
    document.libraries = "<library_nodes>"
                         "<node id=\"A\"><instance_node url=\"#B\"/></node>"
                         "<node id=\"B\"><node><instance_node url=\"#A\"/></node></node>"
                         "</library_nodes>";
    document.nodes = "<node><instance_node url=\"#A\"/></node>";
    EXPECT_THAT([&] { load(document); }, ThrowsMessage<SceneError>(HasSubstr("contains itself")));
}

TEST(Nodes, ExplosionsAreErrors) {
    // Thirty nodes that each show the next twice: 2^30 in all.
    DocumentText document;
    std::string nodes;
    for (int i = 0; i < 30; ++i)
        nodes += fmt::format("<node id=\"n{0}\"><instance_node url=\"#n{1}\"/>"
                             "<instance_node url=\"#n{1}\"/></node>",
                             i, i + 1);
    document.libraries = "<library_nodes>" + nodes + "<node id=\"n30\"/></library_nodes>";
    document.nodes = "<node><instance_node url=\"#n0\"/></node>";
    EXPECT_THAT([&] { load(document); }, ThrowsMessage<SceneError>(HasSubstr("repeats")));
}

TEST(Nodes, DeepChainsAreErrorsNotCrashes) {
    DocumentText document;
    std::string nodes;
    for (int i = 0; i < 100000; ++i)
        nodes += fmt::format("<node id=\"n{}\"><instance_node url=\"#n{}\"/></node>", i, i + 1);
    document.libraries = "<library_nodes>" + nodes + "<node id=\"n100000\"/></library_nodes>";
    document.nodes = "<node><instance_node url=\"#n0\"/></node>";
    EXPECT_THAT([&] { load(document); }, ThrowsMessage<SceneError>(HasSubstr("nested")));
}

TEST(Nodes, TheInstancedVisualSceneIsShown) {
    const std::string text = "<COLLADA>" + triangleLibrary() +
                             "<library_visual_scenes><visual_scene id=\"one\">" + meshNode() +
                             meshNode() + "</visual_scene><visual_scene id=\"two\">" + meshNode() +
                             "</visual_scene></library_visual_scenes>"
                             "<scene><instance_visual_scene url=\"#two\"/></scene></COLLADA>";
    EXPECT_EQ(loadText(text).triangles.size(), 1u);
}

} // namespace
} // namespace stromboli::test
