// What is left out of a mesh, and spheres.

#include "tests/scene/collada/document_text.hpp"

#include "host/core/error.hpp"

namespace stromboli::test {
namespace {

using testing::Contains;
using testing::HasSubstr;

Scene loadTriangles(const std::string& positions, int count, int triangles, const std::string& p,
                    const std::string& transforms = "") {
    DocumentText document;
    document.libraries = meshLibrary(
        positions, count,
        fmt::format("<triangles count=\"{}\">{}<p>{}</p></triangles>", triangles, kVertexInput, p));
    document.nodes = meshNode(transforms);
    return load(document);
}

TEST(Placement, DropsDegenerateAndDistantTriangles) {
    const Scene scene = loadTriangles("0 0 0 1 0 0 0 1 0 2 0 0 1e30 0 0 0 1e200 0", 18, 6,
                                      "0 1 2  0 1 1  0 0 0  0 1 3  0 4 2  0 5 1");
    EXPECT_EQ(scene.triangles.size(), 1u);
    EXPECT_EQ(scene.positions.size(), 3u) << "positions nobody uses are not stored";
    EXPECT_THAT(
        scene.report.warnings,
        Contains(HasSubstr("'Mesh': 5 of 6 triangles left out: 3 of zero area, 2 not finite")));
}

TEST(Placement, KeepsTinyAndHugeTriangles) {
    EXPECT_EQ(loadTriangles("0 0 0 1e-30 0 0 0 1e-30 0", 9, 1, "0 1 2").triangles.size(), 1u);
    EXPECT_EQ(loadTriangles("0 0 0 1e18 0 0 0 1e18 0", 9, 1, "0 1 2").triangles.size(), 1u);
    EXPECT_EQ(loadTriangles("0 0 0 1.2e18 0 0 0 1 0", 9, 1, "0 1 2").triangles.size(), 0u);
}

TEST(Placement, DropsWhatRoundsToNothing) {
    // Distinct in the file, equal in single precision.
    EXPECT_TRUE(loadTriangles("1 0 0 1.00000001 0 0 1 1 0", 9, 1, "0 1 2").triangles.empty());
}

TEST(Placement, OneLinePerMeshForAllInstances) {
    DocumentText document;
    document.libraries = meshLibrary(
        "0 0 0 1 0 0 0 1 0", 9,
        fmt::format("<triangles count=\"2\">{}<p>0 1 2 0 1 1</p></triangles>", kVertexInput));
    document.nodes = meshNode() + meshNode() + meshNode();
    EXPECT_THAT(load(document).report.warnings, Contains(HasSubstr("3 of 6 triangles left out")));
}

TEST(Placement, AnEmptyMeshIsAWarning) {
    const Scene scene = loadTriangles("", 0, 0, "");
    EXPECT_TRUE(scene.triangles.empty());
    EXPECT_THAT(scene.report.warnings, Contains(HasSubstr("'Mesh' has no triangles")));
}

TEST(Placement, NonManifoldMeshesAreFine) {
    const Scene scene = loadTriangles("0 0 0 1 0 0 0 1 0 0 0 1 1 1 1", 15, 6,
                                      "0 1 2 0 1 2 2 1 0 0 1 3 0 1 4 3 4 0");
    EXPECT_EQ(scene.triangles.size(), 6u);
    for (bool cs184 : {false, true}) {
        DocumentText document;
        document.libraries = meshLibrary(
            "0 0 0 1 0 0 0 1 0", 9,
            fmt::format("<triangles count=\"2\">{}<p>0 1 2 0 1 2</p></triangles>", kVertexInput));
        document.nodes = meshNode();
        EXPECT_EQ(load(document, cs184).triangles.size(), 2u);
    }
}

Scene loadSphere(const std::string& radius, const std::string& transforms,
                 const char* profile = "CGL", const char* asset = "") {
    DocumentText document;
    document.asset = asset;
    document.libraries =
        fmt::format("<library_geometries><geometry id=\"mesh\" name=\"Ball\"><extra>"
                    "<technique profile=\"{}\"><sphere><radius>{}</radius></sphere></technique>"
                    "</extra></geometry></library_geometries>",
                    profile, radius);
    document.nodes = meshNode(transforms);
    return load(document);
}

TEST(Placement, Spheres) {
    for (const char* profile : {"CGL", "CMU462"}) {
        const Scene scene = loadSphere(".3", "<translate>1 2 3</translate><scale>-2 2 2</scale>",
                                       profile, "<unit meter=\"0.5\"/><up_axis>Z_UP</up_axis>");
        ASSERT_EQ(scene.spheres.size(), 1u);
        expectNear(scene.spheres[0].center, {-0.5, 1.5, 1});
        EXPECT_FLOAT_EQ(scene.spheres[0].radius, 0.3f);
        EXPECT_EQ(scene.instances.at(scene.spheres[0].instance), "N");
        EXPECT_TRUE(scene.cglDialect);
    }
    EXPECT_TRUE(loadSphere("1", "", "blender").spheres.empty());
    EXPECT_FALSE(loadSphere("1", "", "blender").cglDialect);
}

TEST(Placement, BadSpheresAreDropped) {
    for (const char* radius : {"0", "-1", "1e19", "1e-60"}) {
        const Scene scene = loadSphere(radius, "");
        EXPECT_TRUE(scene.spheres.empty()) << radius;
        EXPECT_THAT(scene.report.warnings, Contains(HasSubstr("'Ball': 1 left out")));
    }
    EXPECT_THAT(loadSphere("1", "<scale>1 2 1</scale>").report.warnings,
                Contains(HasSubstr("scaled unequally")));
    EXPECT_THROW(loadSphere("one", ""), SceneError);
    EXPECT_THROW(loadSphere("1 2", ""), SceneError);
}

} // namespace
} // namespace stromboli::test
