// Shading normals and the side of triangles.

#include "tests/scene/collada/document_text.hpp"

namespace stromboli::test {
namespace {

/// A triangle in the plane z = 0, wound towards +z, with these three normals.
Scene loadNormals(const std::string& normals, const std::string& transforms = "",
                  const std::string& positions = "0 0 0 1 0 0 0 1 0") {
    DocumentText document;
    document.libraries =
        meshLibrary(positions, 9,
                    fmt::format("<triangles count=\"1\">{}{}<p>0 0 1 1 2 2</p></triangles>",
                                kVertexInput, kNormalInput),
                    floats("nrm", normals, 9));
    document.nodes = meshNode(transforms);
    return load(document);
}

glm::vec3 normal(const Scene& scene, int i) {
    return scene.normals[scene.triangles.at(0).normals[i]];
}

bool hasNormals(const Scene& scene) {
    const Triangle& t = scene.triangles.at(0);
    EXPECT_EQ(t.normals[0] == kNoNormals, t.normals[1] == kNoNormals);
    EXPECT_EQ(t.normals[0] == kNoNormals, t.normals[2] == kNoNormals);
    return t.normals[0] != kNoNormals;
}

TEST(Normals, AreMadeUnit) {
    const Scene scene = loadNormals("0 3 4 0 0 1e-300 1e300 0 1e300");
    ASSERT_TRUE(hasNormals(scene));
    expectNear(normal(scene, 0), {0, 0.6, 0.8});
    expectNear(normal(scene, 1), {0, 0, 1});
    expectNear(normal(scene, 2), {std::sqrt(0.5), 0, std::sqrt(0.5)});
}

TEST(Normals, TransformByTheInverseTranspose) {
    const Scene scene = loadNormals("0 1 1 0 0 1 0 0 1", "<scale>1 2 1</scale>");
    expectNear(normal(scene, 0), glm::normalize(glm::dvec3(0, 0.5, 1)));
}

TEST(Normals, SurviveFlatteningAndExtremeScales) {
    expectNear(loadNormals("0 0 1 0 0 1 0.1 0 1", "<scale>1 1 0</scale>")
                   .geometricNormal(
                       loadNormals("0 0 1 0 0 1 0.1 0 1", "<scale>1 1 0</scale>").triangles.at(0)),
               {0, 0, 1});
    for (const char* scale : {"<scale>1e-12 1e-12 1e-12</scale>", "<scale>1e17 1e17 1e17</scale>"})
        expectNear(normal(loadNormals("0 3 4 0 0 1 0 0 1", scale), 0), {0, 0.6, 0.8});
}

TEST(Normals, FlatOnesAreNotStored) {
    EXPECT_FALSE(hasNormals(loadNormals("0 0 1 0 0 1 0 0 1")));
    EXPECT_FALSE(hasNormals(loadNormals("0 0 -1 0 0 -1 0 0 -2")));
    // Six digits of a tilted plane: x + 2 y + 3 z = 0.
    const Scene tilted = loadNormals("0.267261 0.534522 0.801784 0.267261 0.534522 0.801784 "
                                     "0.267261 0.534522 0.801784",
                                     "", "0 0 0 3 0 -1 0 3 -2");
    EXPECT_FALSE(hasNormals(tilted));
    EXPECT_TRUE(tilted.normals.empty());
    EXPECT_TRUE(hasNormals(loadNormals("0 0 1 0 0 1 0 1e-4 1")));
    EXPECT_TRUE(hasNormals(loadNormals("0 0.1 1 0 0.1 1 0 0.1 1")));
}

TEST(Normals, DegenerateOnesAreCounted) {
    for (const char* normals :
         {"0 0 1 0 0 0 0 1 1", "0 0 1 0 1 1 NaN 0 1", "0 INF 1 0 0 1 0 1 1"}) {
        const Scene scene = loadNormals(normals);
        EXPECT_FALSE(hasNormals(scene)) << normals;
        ASSERT_EQ(scene.report.warnings.size(), 2u) << normals; // and no material
        EXPECT_THAT(scene.report.warnings,
                    testing::Contains(
                        testing::HasSubstr("'Mesh': 1 of 1 triangles have zero or non-finite")));
    }
}

TEST(Normals, TrianglesFaceTheSideOfTheirNormals) {
    const Scene towards = loadNormals("0 0.1 1 0 0 1 0 0 1");
    EXPECT_EQ(towards.geometricNormal(towards.triangles[0]), glm::vec3(0, 0, 1));
    const Scene away = loadNormals("0 0.1 -1 0 0 -1 0.1 0 -1");
    EXPECT_EQ(away.geometricNormal(away.triangles[0]), glm::vec3(0, 0, -1));
    // The normals moved along with their corners.
    for (int i = 0; i < 3; ++i) {
        const glm::vec3 p = corner(away, 0, i);
        expectNear(normal(away, i), glm::normalize(p.x == 1   ? glm::dvec3(0, 0, -1)
                                                   : p.y == 1 ? glm::dvec3(0.1, 0, -1)
                                                              : glm::dvec3(0, 0.1, -1)));
    }
}

TEST(Normals, MirroringKeepsTheOutsideOut) {
    // A mesh that has normals...
    const Scene with = loadNormals("0 0.1 1 0 0 1 0 0 1", "<scale>-1 1 1</scale>");
    EXPECT_EQ(with.geometricNormal(with.triangles[0]), glm::vec3(0, 0, 1));
    expectNear(normal(with, 0), glm::normalize(glm::dvec3(0, 0.1, 1)));
    const Scene through = loadNormals("0 0.1 1 0 0 1 0 0 1", "<scale>1 1 -1</scale>");
    EXPECT_EQ(through.geometricNormal(through.triangles[0]), glm::vec3(0, 0, -1));
    expectNear(normal(through, 0), glm::normalize(glm::dvec3(0, 0.1, -1)));
    // ...and by the winding alone.
    DocumentText document;
    document.libraries = triangleLibrary();
    for (const char* scale : {"<scale>-1 1 1</scale>", "<scale>1 -1 1</scale>",
                              "<scale>-1 -1 1</scale>", "<scale>1 1 1</scale>"}) {
        document.nodes = meshNode(scale);
        const Scene scene = load(document);
        EXPECT_EQ(scene.geometricNormal(scene.triangles[0]), glm::vec3(0, 0, 1)) << scale;
    }
}

} // namespace
} // namespace stromboli::test
