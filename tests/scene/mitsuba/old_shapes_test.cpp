// Shapes of Mitsuba 0.x, and what they have of old.

#include "scene/build/tubes.hpp"
#include "scene/mitsuba/smooth_normals.hpp"
#include "scene/mitsuba/solids.hpp"
#include "scene/model/srgb.hpp"
#include "tests/scene/mitsuba/mitsuba_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <set>

namespace stromboli::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

Scene loadFile(const std::string& type, const std::string& name, const std::string& inside = "",
               const char* version = "0.6.0") {
    return loadText(sceneText(fmt::format("<shape type=\"{}\"><string name=\"filename\" "
                                          "value=\"{}\"/>{}</shape>",
                                          type, name, inside),
                              version));
}

double areaOf(const Scene& scene) {
    double area = 0;
    for (const Triangle& t : scene.triangles) {
        const auto p = [&](size_t i) { return glm::dvec3(scene.positions[t.corner[i]]); };
        area += glm::length(glm::cross(p(1) - p(0), p(2) - p(0))) / 2;
    }
    return area;
}

/// A convex outline's mean width is its length over pi: a tube of few sides that is as wide as a
/// round one has its area.
TEST(MitsubaHair, IsOfTubes) {
    writeFile("hair.txt", "0 0 0\n0 0 1\n\n5 0 0\n5 0 1\n5 2 1\n");
    const Scene one = loadFile("hair", "hair.txt", "<float name=\"radius\" value=\"0.01\"/>");
    EXPECT_EQ(one.triangles.size(), 3 * 12u);
    EXPECT_NEAR(areaOf(one), 2 * std::numbers::pi * 0.01 * 4, 0.005);
    for (const glm::vec3& n : one.normals)
        EXPECT_NEAR(glm::length(n), 1, 1e-5);
    EXPECT_THAT(one.report.forgiven, IsEmpty());
    const Bounds bounds = one.bounds();
    EXPECT_NEAR(bounds.hi.y, 2, 0.02);
    EXPECT_NEAR(bounds.lo.x, -0.01, 0.001);
}

TEST(MitsubaHair, IsInBinaryFilesToo) {
    std::string bytes = "BINARY_HAIR";
    const auto add = [&](auto value) {
        bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    add(uint32_t(4));
    const float inf = std::numeric_limits<float>::infinity();
    for (const float value :
         {0.0f, 0.0f, 0.0f, 0.0f, 0.0f, 1.0f, inf, 5.0f, 0.0f, 0.0f, 5.0f, 0.0f, 3.0f})
        add(value);
    writeFile("hair.bin", bytes);
    const Scene scene = loadFile("hair", "hair.bin", "<float name=\"radius\" value=\"0.01\"/>");
    EXPECT_EQ(scene.triangles.size(), 2 * 12u);
    EXPECT_NEAR(areaOf(scene), 2 * std::numbers::pi * 0.01 * 4, 0.01);
}

/// Knots where a strand hardly bends are left out.
TEST(MitsubaHair, IsStraightened) {
    std::string text;
    for (int i = 0; i <= 100; ++i)
        text += fmt::format("0 0 {}\n", i * 0.01);
    writeFile("straight.txt", text);
    EXPECT_EQ(loadFile("hair", "straight.txt").triangles.size(), 12u);
}

TEST(MitsubaHair, CurvesHaveRadii) {
    writeFile("curve.txt", "0 0 0 0.01\n0 0 1 0.01\n0 0 2 0.03\n0 0 3 0.03\n");
    const Scene line = loadFile("linearcurve", "curve.txt", "", "3.0.0");
    EXPECT_NEAR(line.bounds().hi.z, 3, 1e-6);
    EXPECT_NEAR(areaOf(line), 2 * std::numbers::pi * (0.01 + 0.02 + 0.03), 0.02);
    const Scene spline = loadFile("bsplinecurve", "curve.txt", "", "3.0.0");
    EXPECT_NEAR(spline.bounds().lo.z, 1, 1e-6); // of evenly spaced knots: from the second
    EXPECT_NEAR(spline.bounds().hi.z, 2, 1e-6); // to the last but one
}

/// As many lines stand for a segment as it takes to be off by a tenth of the width: one where it is
/// straight; six where it bends by far more than its width.
TEST(MitsubaHair, CurvesHaveLinesWhereTheyBend) {
    writeFile("straight_curve.txt", "0 0 0 0.01\n0 0 1 0.01\n0 0 2 0.01\n0 0 3 0.01\n");
    EXPECT_EQ(loadFile("bsplinecurve", "straight_curve.txt", "", "3.0.0").triangles.size(), 12u);
    writeFile("bent_curve.txt", "0 0 0 0.01\n0 0 1 0.01\n0 1 1 0.01\n0 1 0 0.01\n");
    EXPECT_EQ(loadFile("bsplinecurve", "bent_curve.txt", "", "3.0.0").triangles.size(), 6 * 12u);
}

/// Six sides of millions of segments would take gigabytes; three are as wide in the mean.
TEST(MitsubaHair, OfManyPointsHasThreeSides) {
    std::string text;
    constexpr size_t kPoints = build::kMostDetailedPoints + 1;
    for (size_t i = 0; i < kPoints; ++i)
        text += fmt::format("{} {} 0 0.01\n", i % 2, i);
    writeFile("many.txt", text);
    const Scene scene = loadFile("linearcurve", "many.txt", "", "3.0.0");
    EXPECT_EQ(scene.triangles.size(), (kPoints - 1) * 6);
    EXPECT_THAT(scene.report.assumed, testing::Contains(testing::HasSubstr("three sides")));
}

TEST(MitsubaHair, WrongFilesSayWhy) {
    writeFile("bald.txt", "0 0 0\n");
    const auto problem = [](const std::string& name) {
        return problemInOld("<shape type=\"hair\"><string name=\"filename\" value=\"" + name +
                            "\"/></shape>");
    };
    EXPECT_THAT(problem("bald.txt"), HasSubstr("has no strand of two points or more"));
    writeFile("flat.txt", "0 0\n");
    EXPECT_THAT(problem("flat.txt"), HasSubstr("has a line of 2 numbers"));
}

/// A roof, whose heights are luminances.
TEST(MitsubaHeightfields, AreCornersForTexels) {
    const std::string name = writePicture("heights.tga", 3, 2,
                                          {{0, 0, 0, 255},
                                           {255, 255, 255, 255},
                                           {0, 0, 0, 255},
                                           {0, 0, 0, 255},
                                           {255, 255, 255, 255},
                                           {0, 0, 0, 255}});
    const Scene scene = loadFile("heightfield", name, "<float name=\"scale\" value=\"0.5\"/>");
    EXPECT_EQ(scene.triangles.size(), 4u);
    EXPECT_NEAR(areaOf(scene), 2 * 2 * std::sqrt(1 + 0.25), 1e-5);
    const Bounds bounds = scene.bounds();
    EXPECT_EQ(bounds.lo, glm::vec3(-1, -1, 0));
    EXPECT_EQ(bounds.hi, glm::vec3(1, 1, 0.5f));
    EXPECT_FALSE(scene.normals.empty());
    EXPECT_TRUE(loadFile("heightfield", name, "<boolean name=\"shadingNormals\" value=\"false\"/>")
                    .normals.empty());
    const Scene nested = loadOld("<shape type=\"heightfield\"><texture type=\"scale\"><float "
                                 "name=\"scale\" value=\"0.25\"/><texture type=\"bitmap\"><string "
                                 "name=\"filename\" value=\"" +
                                 name + "\"/></texture></texture></shape>");
    EXPECT_EQ(nested.bounds().hi.z, 0.25f);
    EXPECT_THAT(nested.report.forgiven, IsEmpty());
}

/// Two faces at an angle of 90 degrees, and one in the plane of the first.
TEST(MitsubaSmoothing, EndsAtAnAngle) {
    build::Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}};
    const auto reset = [&] {
        mesh.parts = {{{{{0}, {1}, {2}}}, {{{0}, {2}, {3}}}, {{{0}, {2}, {4}}}}};
    };
    const auto normal = [&](size_t triangle) {
        return mesh.normals[mesh.parts[0][triangle][0].normal];
    };
    reset();
    mitsuba::smoothUpTo(mesh, 80);
    EXPECT_NEAR(glm::distance(normal(0), glm::dvec3(0, 0, 1)), 0, 1e-9);
    EXPECT_NEAR(glm::distance(normal(1), glm::dvec3(1, 0, 0)), 0, 1e-9);
    EXPECT_NEAR(glm::distance(normal(2), glm::dvec3(0, 0, 1)), 0, 1e-9);
    reset();
    mitsuba::smoothUpTo(mesh, 100);
    EXPECT_NEAR(glm::distance(normal(1), glm::normalize(glm::dvec3(1, 0, 2))), 0, 1e-9);
}

TEST(MitsubaSmoothing, TakesThePlaceOfTheFilesNormals) {
    writeFile("lit.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvn 1 0 0\nf 1//1 2//1 3//1\n");
    EXPECT_EQ(loadFile("obj", "lit.obj").normals.at(0), glm::vec3(1, 0, 0));
    const Scene scene = loadFile("obj", "lit.obj", "<float name=\"maxSmoothAngle\" value=\"30\"/>");
    EXPECT_TRUE(scene.normals.empty()); // those of a plane say nothing
    EXPECT_THAT(scene.report.forgiven, IsEmpty());
}

/// A mesh of two materials of a library, in a scene of Mitsuba 0.x.
class MitsubaObjMaterials : public testing::Test {
  protected:
    void SetUp() override {
        writeFile("two.mtl", "newmtl red\nKd 1 0 0\nnewmtl blue\nKd 0 0 1\n");
        writeFile("two.obj", "mtllib two.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\n"
                             "usemtl red\nf 1 2 3\nusemtl blue\nf 2 4 3\n");
    }

    static std::vector<glm::vec3> colorsOf(const Scene& scene) {
        std::vector<glm::vec3> colors;
        for (const Triangle& t : scene.triangles) {
            const glm::vec3* color = scene.materials.at(t.material).baseColor();
            colors.push_back(color ? *color : glm::vec3(-1));
        }
        return colors;
    }
};

constexpr glm::vec3 kRed{1, 0, 0}, kGreen{0, 1, 0}, kBlue{0, 0, 1};
const std::string kGreenBsdf = "<rgb name=\"reflectance\" value=\"0 1 0\"/></bsdf>";

TEST_F(MitsubaObjMaterials, AreThoseOfTheFile) {
    EXPECT_THAT(colorsOf(loadFile("obj", "two.obj")), ElementsAre(kRed, kBlue));
    const glm::vec3 grey(0.5f);
    EXPECT_THAT(
        colorsOf(loadFile("obj", "two.obj", "<boolean name=\"loadMaterials\" value=\"false\"/>")),
        ElementsAre(grey, grey));
    EXPECT_THAT(colorsOf(loadFile("obj", "two.obj", "", "3.0.0")), ElementsAre(grey, grey));
}

TEST_F(MitsubaObjMaterials, ComeAfterTheShapes) {
    EXPECT_THAT(colorsOf(loadFile("obj", "two.obj", "<bsdf type=\"diffuse\">" + kGreenBsdf)),
                ElementsAre(kGreen, kGreen));
    EXPECT_THAT(colorsOf(loadFile("obj", "two.obj",
                                  "<bsdf type=\"diffuse\" name=\"blue\">" + kGreenBsdf +
                                      "<bsdf type=\"diffuse\" name=\"other\">" + kGreenBsdf)),
                ElementsAre(kRed, kGreen));
}

/// One that has a name is that of one material only.
TEST_F(MitsubaObjMaterials, AreReplacedOneByOne) {
    const std::string blue = "<bsdf type=\"diffuse\" name=\"blue\">" + kGreenBsdf;
    EXPECT_THAT(colorsOf(loadFile("obj", "two.obj", blue)), ElementsAre(kRed, kGreen));
    const std::string all = "<bsdf type=\"diffuse\" name=\"bsdf\">" + kGreenBsdf;
    EXPECT_THAT(colorsOf(loadFile("obj", "two.obj", all)), ElementsAre(kGreen, kGreen));
}

/// A file without a library has names alone.
TEST_F(MitsubaObjMaterials, NeedNoLibrary) {
    writeFile("bare.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl a\nf 1 2 3\nusemtl b\nf 1 2 3\n");
    const std::string a = "<bsdf type=\"diffuse\" name=\"a\">" + kGreenBsdf;
    const Scene both = loadFile("obj", "bare.obj", a + "<bsdf type=\"diffuse\" name=\"b\"/>");
    EXPECT_THAT(colorsOf(both), ElementsAre(kGreen, glm::vec3(0.5f)));
    EXPECT_THAT(both.report.forgiven, IsEmpty());
    const Scene one = loadFile("obj", "bare.obj", a);
    EXPECT_THAT(colorsOf(one), ElementsAre(kGreen, glm::vec3(0.5f)));
    EXPECT_THAT(one.report.forgiven, ElementsAre(HasSubstr("there is no material 'b'")));
}

/// What a file says of materials is not reported where the scene has others.
TEST_F(MitsubaObjMaterials, AreNotMissedWhereTheyAreNotWanted) {
    writeFile("lost.obj", "mtllib lost.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl red\nf 1 2 3\n");
    EXPECT_THAT(loadFile("obj", "lost.obj", "<bsdf type=\"diffuse\">" + kGreenBsdf).report.forgiven,
                IsEmpty());
    EXPECT_FALSE(loadFile("obj", "lost.obj").report.forgiven.empty());
}

/// Between two media there is nothing where a shape has no BSDF; 0.3 had a diffuse one.
TEST(MitsubaOldShapes, BordersOfMediaAreNotThere) {
    const std::string shape = "<shape type=\"sphere\"><medium name=\"interior\" "
                              "type=\"homogeneous\"/>";
    const auto opacity = [](const std::string& text, const char* version) {
        const Material m = loadText(sceneText(text + "</shape>", version)).materials.at(0);
        return m.alphaMode == AlphaMode::Opaque ? 1.0f : m.opacity;
    };
    EXPECT_EQ(opacity(shape, "0.6.0"), 0);
    EXPECT_EQ(opacity(shape, "0.3.0"), 1);
    EXPECT_EQ(opacity(shape + "<bsdf type=\"diffuse\"/>", "0.6.0"), 1);
}

TEST(MitsubaOldShapes, VertexColors) {
    writeFile("painted_old.ply",
              "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
              "property float z\nproperty float r\nproperty float g\nproperty float b\n"
              "element face 1\nproperty list uchar int vertex_indices\n"
              "end_header\n0 0 0 1 0 0\n1 0 0 0 1 0\n0 1 0 0 0 1\n3 0 1 2\n");
    const Scene scene = loadFile("ply", "painted_old.ply",
                                 "<boolean name=\"srgb\" value=\"false\"/><bsdf type=\"diffuse\">"
                                 "<texture type=\"vertexcolors\" name=\"reflectance\"/></bsdf>");
    ASSERT_EQ(scene.attributeCorners.size(), 1u);
    EXPECT_EQ(scene.attributes[scene.attributeCorners[0][1]].color, glm::vec4(0, 1, 0, 1));
}

/// Colours of vertices are sRGB unless the shape says otherwise, whole numbers or not.
TEST(MitsubaOldShapes, VertexColorsAreDecoded) {
    for (const auto& [type, value, scale] : {std::tuple("uchar", 51, 255.0), {"float", 1, 1.0}}) {
        writeFile("decoded_old.ply",
                  fmt::format("ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\n"
                              "property float y\nproperty float z\nproperty {0} red\n"
                              "property {0} green\nproperty {0} blue\nelement face 1\n"
                              "property list uchar int vertex_indices\nend_header\n"
                              "0 0 0 {1} 0 0\n1 0 0 {1} 0 0\n0 1 0 {1} 0 0\n3 0 1 2\n",
                              type, type == std::string("float") ? "0.2" : std::to_string(value)));
        const auto red = [](const std::string& inside) {
            const Scene scene =
                loadFile("ply", "decoded_old.ply",
                         inside + "<bsdf type=\"diffuse\"><texture type=\"vertexcolors\" "
                                  "name=\"reflectance\"/></bsdf>");
            return scene.attributes[scene.attributeCorners.at(0)[1]].color.x;
        };
        EXPECT_NEAR(red(""), srgbToLinear(0.2), 1e-6) << type;
        EXPECT_NEAR(red("<boolean name=\"srgb\" value=\"false\"/>"), 0.2, 1e-6) << type;
    }
}

TEST(MitsubaOldShapes, CylindersBeginAcrossTheirOwnAxis) {
    const build::Mesh lying = mitsuba::cylinderMesh({0, 0, 0}, {1, 0, 0}, 1, true);
    EXPECT_NEAR(glm::distance(lying.positions.at(0), glm::dvec3(0, -1, 0)), 0, 1e-12);
    const build::Mesh upright = mitsuba::cylinderMesh({0, 0, 0}, {0, 1, 0}, 1, true);
    EXPECT_NEAR(glm::distance(upright.positions.at(0), glm::dvec3(1, 0, 0)), 0, 1e-12);
    const Scene scene = loadOld("<shape type=\"cylinder\"><point name=\"p1\" x=\"1\"/></shape>");
    EXPECT_NEAR(glm::distance(glm::dvec3(scene.positions.at(0)), glm::dvec3(0, -1, 0)), 0, 1e-6);
}

TEST(MitsubaOldShapes, MaterialsOfFilesHaveAnyName) {
    writeFile("named_old.mtl", "newmtl myWood\nKd 0.5 0.5 0.5\nnewmtl B\nKd 0.5 0.5 0.5\n");
    writeFile("named_old.obj",
              "mtllib named_old.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl myWood\nf 1 2 3\n"
              "usemtl B\nf 1 3 2\n");
    const Scene scene = loadFile("obj", "named_old.obj",
                                 "<bsdf type=\"diffuse\" name=\"myWood\"><rgb "
                                 "name=\"reflectance\" value=\"0.25\"/></bsdf><bsdf "
                                 "type=\"diffuse\" name=\"B\"><rgb name=\"reflectance\" "
                                 "value=\"0.75\"/></bsdf>");
    EXPECT_EQ(scene.materials.at(scene.triangles.at(0).material).albedo, glm::vec3(0.25f));
    EXPECT_EQ(scene.materials.at(scene.triangles.at(1).material).albedo, glm::vec3(0.75f));
}

} // namespace
} // namespace stromboli::test
