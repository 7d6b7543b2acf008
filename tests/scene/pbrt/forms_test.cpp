// Shapes: their areas, sides and coordinates; objects and what is shared of them.

#include "scene/build/tubes.hpp"
#include "tests/scene/pbrt/pbrt_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace stromboli::test {
namespace {

using std::numbers::pi;
using testing::Each;
using testing::HasSubstr;

double areaOf(const Scene& scene) {
    double area = 0;
    for (const Triangle& t : scene.triangles)
        area += 0.5 * glm::length(glm::cross(
                          glm::dvec3(scene.positions[t.corner[1]] - scene.positions[t.corner[0]]),
                          glm::dvec3(scene.positions[t.corner[2]] - scene.positions[t.corner[0]])));
    return area;
}

Scene loadShape(const std::string& shape, bool isV3 = false) {
    const std::string text = "Shape " + shape;
    return isV3 ? loadV3(text) : loadV4(text);
}

TEST(PbrtShapes, HaveTheirAreas) {
    // A polygon of 256 sides lacks a share of 1e-4 of the circle.
    const auto expectArea = [](const std::string& shape, double area) {
        EXPECT_NEAR(areaOf(loadShape(shape)), area, 3e-4 * area) << shape;
    };
    expectArea("\"sphere\" \"float radius\" 2 \"float zmax\" 1", 4 * pi * 3);
    expectArea("\"sphere\" \"float phimax\" 90", pi);
    expectArea("\"cylinder\" \"float radius\" 2 \"float zmin\" 0 \"float zmax\" 3", 12 * pi);
    expectArea("\"cylinder\" \"float phimax\" 180", 2 * pi);
    expectArea("\"disk\" \"float radius\" 3 \"float innerradius\" 1", 8 * pi);
    expectArea("\"cone\" \"float radius\" 3 \"float height\" 4", 15 * pi);
    expectArea("\"paraboloid\"", pi / 6 * (5 * std::sqrt(5.0) - 1));
    expectArea("\"hyperboloid\" \"point3 p1\" [1 0 0] \"point3 p2\" [1 0 2]", 4 * pi);
}

TEST(PbrtShapes, WholeSpheresStaySpheres) {
    const Scene scene = loadShape("\"sphere\" \"float radius\" 2");
    ASSERT_EQ(scene.spheres.size(), 1u);
    EXPECT_FLOAT_EQ(scene.spheres[0].radius, 2);
    EXPECT_EQ(loadV4("Scale 1 2 1 Shape \"sphere\"").spheres.size(), 0u);
    EXPECT_EQ(loadV4("Translate 1 2 3 Scale 2 2 2 Shape \"sphere\"").spheres[0].center,
              glm::vec3(1, 2, 3));
}

/// Mean of normals times places: positive where the fronts are outside.
double outwards(const Scene& scene) {
    double sum = 0;
    for (const Triangle& t : scene.triangles) {
        glm::vec3 middle(0.0f);
        for (const uint32_t corner : t.corner)
            middle += scene.positions[corner] / 3.0f;
        sum += glm::dot(scene.geometricNormal(t), middle);
    }
    return sum / double(scene.triangles.size());
}

TEST(PbrtShapes, FaceOutwards) {
    for (const char* shape : {"\"sphere\" \"float phimax\" 300", "\"cylinder\"", "\"cone\""}) {
        EXPECT_GT(outwards(loadShape(shape)), 0) << shape;
        EXPECT_LT(outwards(loadV4("ReverseOrientation Shape " + std::string(shape))), 0) << shape;
        EXPECT_GT(outwards(loadV4("Scale -1 1 1 Shape " + std::string(shape))), 0) << shape;
    }
    const Scene disk = loadShape("\"disk\"");
    EXPECT_FLOAT_EQ(disk.geometricNormal(disk.triangles[0]).z, 1);
}

TEST(PbrtTriangles, HaveNormalsAndCoordinates) {
    const std::string picture = writePicture("red.tga", 1, 1, {{255, 0, 0}});
    const Scene scene = loadV4(
        "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"" + picture +
        "\" Material \"diffuse\" \"texture reflectance\" \"t\" Shape \"trianglemesh\" \"point3 P\" "
        "[0 0 0 1 0 0 0 1 0] \"integer indices\" [0 1 2] \"normal N\" [0 0 1 0 0 1 0 1 1] \"point2 "
        "uv\" [0 0 2 0 0 3]");
    ASSERT_EQ(scene.triangles.size(), 1u);
    EXPECT_NE(scene.triangles[0].normals[0], kNoNormals);
    ASSERT_EQ(scene.attributeCorners.size(), 1u);
    EXPECT_EQ(scene.attributes[scene.attributeCorners[0][1]].uv[0], glm::vec2(2, 0));
    EXPECT_EQ(scene.attributes[scene.attributeCorners[0][2]].uv[0], glm::vec2(0, 3));
}

TEST(PbrtTriangles, WithoutCoordinatesHaveThoseOfPbrt) {
    const std::string picture = writePicture("red.tga", 1, 1, {{255, 0, 0}});
    const Scene scene =
        loadV4("Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"" + picture +
               "\" Material \"diffuse\" \"texture reflectance\" \"t\"" + kTriangle);
    EXPECT_EQ(scene.attributes[scene.attributeCorners[0][2]].uv[0], glm::vec2(1, 1));
}

TEST(PbrtTriangles, WithWrongCornersAreLeftOut) {
    const std::string mesh = "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer "
                             "indices\" [0 1 2 0 1 7]";
    EXPECT_EQ(loadV4(mesh).triangles.size(), 1u);
    EXPECT_THAT(problemInV4(mesh), HasSubstr("has 1 triangles with corners that are not there"));
    EXPECT_THAT(problemInV4("Shape \"trianglemesh\""), HasSubstr("has no triangles"));
    EXPECT_THAT(problemInV4("Shape \"torus\""), HasSubstr("'torus' is no shape that is read"));
}

const char* const kQuadPly =
    "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty "
    "float y\nproperty float z\nproperty float u\nproperty float v\nelement "
    "face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0 0 0\n"
    "1 0 0 1 0\n1 1 0 1 .25\n0 1 0 0 .25\n4 0 1 2 3\n";

TEST(PbrtPly, IsRead) {
    writeFile("quad.ply", kQuadPly);
    const std::string picture = writePicture("red.tga", 1, 1, {{255, 0, 0}});
    const Scene scene =
        loadV4("Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"" + picture +
               "\" Material \"diffuse\" \"texture reflectance\" \"t\" Shape \"plymesh\" \"string "
               "filename\" \"quad.ply\"");
    EXPECT_EQ(scene.triangles.size(), 2u);
    writeFile("quad.ply.gz", gzip(kQuadPly));
    EXPECT_EQ(loadV4("Shape \"plymesh\" \"string filename\" \"quad.ply.gz\"").triangles.size(), 2u);
    float most = 0;
    for (const VertexAttributes& a : scene.attributes)
        most = std::max(most, a.uv[0].y);
    EXPECT_FLOAT_EQ(most, 0.25f);
    EXPECT_THAT(problemInV4("Shape \"plymesh\" \"string filename\" \"no.ply\""),
                HasSubstr("names the file 'no.ply', which is not there"));
}

TEST(PbrtPatches, AreBilinear) {
    const Scene plane = loadShape("\"bilinearmesh\" \"point3 P\" [0 0 0 2 0 0 0 3 0 2 3 0]");
    EXPECT_EQ(plane.triangles.size(), 2u);
    EXPECT_NEAR(areaOf(plane), 6, 1e-6);
    EXPECT_FLOAT_EQ(plane.geometricNormal(plane.triangles[0]).z, 1);
    const Scene bent = loadShape("\"bilinearmesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 1]");
    EXPECT_GT(bent.triangles.size(), 100u);
}

const char* const kOctahedron =
    "\"loopsubdiv\" \"integer levels\" {} \"point3 P\" [1 0 0 -1 0 0 0 1 "
    "0 0 -1 0 0 0 1 0 0 -1] \"integer indices\" [0 2 4 2 1 4 1 3 4 3 0 "
    "4 2 0 5 1 2 5 3 1 5 0 3 5]";

TEST(PbrtSubdivision, IsLoops) {
    const Scene scene = loadShape(fmt::format(fmt::runtime(kOctahedron), 2));
    EXPECT_EQ(scene.triangles.size(), 8u * 16u);
    EXPECT_GT(outwards(scene), 0);
    // A vertex of valence 4 of an octahedron in the limit: 1 - 4 / (4 + 3 / (8 beta)) of it.
    const double limit = 1.0 / (4 + 3.0 / (8 * 3.0 / 32));
    EXPECT_NEAR(loadShape(fmt::format(fmt::runtime(kOctahedron), 0)).bounds().hi.x, 1 - 4 * limit,
                1e-6);
    EXPECT_NEAR(scene.bounds().hi.x, 1 - 4 * limit, 1e-6);
    for (const glm::vec3& n : scene.normals)
        EXPECT_NEAR(glm::length(n), 1, 1e-5);
    // On the border of a single triangle a corner is the mean of 3/5 of it and the others.
    const Scene open =
        loadShape("\"loopsubdiv\" \"integer levels\" 1 \"point3 P\" [0 0 0 1 0 0 0 1 "
                  "0] \"integer indices\" [0 1 2]");
    EXPECT_EQ(open.triangles.size(), 4u);
    EXPECT_GT(open.bounds().lo.x, 0);
    EXPECT_NEAR(open.bounds().lo.x, 0.1, 0.1);
}

TEST(PbrtCurves, AreTubes) {
    const std::string points = "\"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0] \"float width\" .2";
    const Scene scene = loadShape("\"curve\" " + points);
    EXPECT_NEAR(areaOf(scene), 2 * pi * 0.1 * 3, 0.02);
    EXPECT_EQ(scene.triangles.size(), 12u); // straight
    EXPECT_GT(loadShape("\"curve\" \"point3 P\" [0 0 0 0 1 0 1 1 0 1 0 0] \"float width\" .1")
                  .triangles.size(),
              70u);
    const Scene many = loadV4("Shape \"curve\" " + points + " Shape \"curve\" " + points +
                              " Shape \"curve\" \"string basis\" \"bspline\" " + points);
    EXPECT_EQ(many.instances.size(), 1u); // one mesh
    EXPECT_NEAR(areaOf(many), 2 * pi * 0.1 * 7, 0.05);
    EXPECT_EQ(loadV4("Shape \"curve\" " + points + " Translate 0 0 1 Shape \"curve\" " + points)
                  .instances.size(),
              2u);
}

/// Six sides of millions of curves would take gigabytes; three are as wide in the mean.
TEST(PbrtCurves, OfManyPointsHaveThreeSides) {
    const std::string curve =
        "Shape \"curve\" \"point3 P\" [0 0 0 1 0 0 2 0 0 3 0 0] \"float width\" .2\n";
    constexpr size_t kCurves = build::kMostDetailedPoints / 4 + 1;
    std::string all;
    for (size_t i = 0; i < kCurves; ++i)
        all += curve;
    const Scene scene = loadV4(all);
    EXPECT_EQ(scene.triangles.size(), kCurves * 6);
    EXPECT_NEAR(areaOf(scene), double(kCurves) * 2 * pi * 0.1 * 3, double(kCurves) * 0.02);
    EXPECT_THAT(scene.report.assumed, testing::Contains(testing::HasSubstr("three sides")));
}

TEST(PbrtOldShapes, AreGrids) {
    const Scene field = loadShape("\"heightfield\" \"integer nu\" 2 \"integer nv\" 3 \"float Pz\" "
                                  "[0 0 0 0 0 0]",
                                  true);
    EXPECT_EQ(field.triangles.size(), 4u);
    EXPECT_NEAR(areaOf(field), 1, 1e-6);
    const Scene patch = loadShape(
        "\"nurbs\" \"integer nu\" 3 \"integer uorder\" 3 \"float uknots\" [0 0 0 1 1 1] "
        "\"integer nv\" 2 \"integer vorder\" 2 \"float vknots\" [0 0 1 1] \"float Pw\" [1 "
        "0 0 1  .70710678 .70710678 0 .70710678  0 1 0 1  1 0 2 1  .70710678 .70710678 "
        "1.41421356 .70710678  0 1 2 1]",
        true);
    EXPECT_NEAR(areaOf(patch), pi, 2e-3); // a quarter of a cylinder
    for (const glm::vec3& p : patch.positions)
        EXPECT_NEAR(p.x * p.x + p.y * p.y, 1, 1e-5);
}

TEST(PbrtObjects, ShareTheirTriangles) {
    const std::string text =
        "Film \"rgb\" WorldBegin ObjectBegin \"a\" Translate 1 0 0 Shape \"trianglemesh\" \"point3 "
        "P\" "
        "[0 0 0 1 0 0 0 1 0 1 1 0] \"integer indices\" [0 1 2 1 3 2 2 1 0 2 3 1] "
        "ObjectEnd ObjectInstance \"a\" Translate 0 5 0 Scale 2 2 2 ObjectInstance \"a\"";
    const Scene copies = loadText(text);
    EXPECT_EQ(copies.triangles.size(), 8u);
    EXPECT_FLOAT_EQ(copies.bounds().lo.x, 1);
    EXPECT_FLOAT_EQ(copies.bounds().hi.x, 4);
    EXPECT_FLOAT_EQ(copies.bounds().hi.y, 7);
    SceneConventions conventions;
    conventions.instances = InstanceSharing::On;
    const Scene shared = loadPbrt(writeFile("scene.pbrt", text), conventions);
    EXPECT_EQ(shared.triangles.size(), 4u);
    EXPECT_EQ(shared.placements.size(), 2u);
}

TEST(PbrtObjects, ThatAreNotThereAreSaid) {
    EXPECT_THAT(problemInV4("ObjectInstance \"a\""), HasSubstr("which is not there"));
    EXPECT_THAT(problemInV4("ObjectEnd"), HasSubstr("ends what has not begun"));
    EXPECT_THAT(problemInV4("ObjectBegin \"a\" AreaLightSource \"diffuse\" " +
                            std::string(kTriangle) + "ObjectEnd"),
                HasSubstr("is an area light in an object"));
}

TEST(PbrtAlpha, IsAShareInV4AndATestInV3) {
    const std::string shape = "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"integer "
                              "indices\" [0 1 2] \"float alpha\" .25";
    EXPECT_EQ(loadV4(shape).materials.at(0).alphaMode, AlphaMode::Blend);
    EXPECT_EQ(loadV4(shape).materials.at(0).opacity, 0.25f);
    EXPECT_EQ(loadV3(shape).materials.at(0).alphaMode, AlphaMode::Mask);
    EXPECT_EQ(loadV3(shape).materials.at(0).opacity, 1);
}

} // namespace
} // namespace stromboli::test
