// Vertices, faces, groups: every statement of OBJ that is read.

#include "tests/scene/obj/obj_folder.hpp"

#include <cmath>

namespace stromboli::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

const std::string kSquare = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

double areaOf(const Scene& scene) {
    double area = 0;
    for (const Triangle& t : scene.triangles) {
        const glm::dvec3 a = scene.positions[t.corner[0]], b = scene.positions[t.corner[1]],
                         c = scene.positions[t.corner[2]];
        area += glm::length(glm::cross(b - a, c - a)) / 2;
    }
    return area;
}

glm::vec2 uvOf(const Scene& scene, size_t triangle, int corner) {
    return scene.attributes.at(scene.attributeCorners.at(triangle)[corner]).uv[0];
}

TEST(ObjGeometry, PolygonsOfAnySizeAreCut) {
    EXPECT_EQ(loadObjText(kSquare + "f 1 2 3 4\n").triangles.size(), 2u);
    // An arrowhead, concave at (1, 1), of area 4 - 1.
    const Scene arrow = loadObjText("v 0 0 0\nv 1 1 0\nv 2 0 0\nv 1 4 0\nf 1 2 3 4\n");
    EXPECT_NEAR(areaOf(arrow), 3, 1e-6);
    // 300 corners: more than libraries have room for in a byte.
    std::string text, face = "f";
    for (int i = 0; i < 300; ++i) {
        const double angle = 2 * 3.14159265358979 * i / 300;
        text += fmt::format("v {} {} 0\n", std::cos(angle), std::sin(angle));
        face += fmt::format(" {}", i + 1);
    }
    const Scene circle = loadObjText(text + face + "\n");
    EXPECT_EQ(circle.triangles.size(), 298u);
    EXPECT_NEAR(areaOf(circle), 150 * std::sin(2 * 3.14159265358979 / 300), 1e-5);
}

TEST(ObjGeometry, NegativeNumbersCountBack) {
    const Scene scene = loadObjText(kSquare + "f -4 -3 -2\nv 5 5 5\nf -4 -3 -2\n");
    ASSERT_EQ(scene.triangles.size(), 2u);
    EXPECT_EQ(scene.positions[scene.triangles[0].corner[0]], glm::vec3(0));
    EXPECT_EQ(scene.positions[scene.triangles[1].corner[0]], glm::vec3(1, 0, 0));
}

TEST(ObjGeometry, TextureCoordinatesPointUpAndNormalsAreKept) {
    const Scene scene = loadObjText(
        kSquare + "vt 0.25 0.125\nvt 1\nvn 0 0.6 0.8\nvn 0 0 1\nf 1/1/1 2/2/1 3/-1/2\n");
    EXPECT_EQ(uvOf(scene, 0, 0), glm::vec2(0.25f, 0.875f));
    EXPECT_EQ(uvOf(scene, 0, 1), glm::vec2(1, 1)); // v is 0 where it is left out
    EXPECT_NEAR(scene.normals.at(scene.triangles[0].normals[0]).y, 0.6, 1e-6);
    // Positions and normals alone have no attributes.
    EXPECT_TRUE(loadObjText(kSquare + "vn 0 0.6 0.8\nf 1//1 2//1 3//1\n").attributes.empty());
}

TEST(ObjGeometry, ColoursOfVerticesAreSrgb) {
    const Scene scene = loadObjText("v 0 0 0 1 0 0.5\nv 1 0 0 1 0 0.5\nv 0 1 0\nf 1 2 3\n");
    ASSERT_EQ(scene.attributeCorners.size(), 1u);
    const glm::vec4 color = scene.attributes[scene.attributeCorners[0][0]].color;
    EXPECT_EQ(color.x, 1);
    EXPECT_EQ(color.y, 0);
    EXPECT_NEAR(color.z, 0.214041, 1e-5); // ((0.5 + 0.055) / 1.055)^2.4
    EXPECT_EQ(scene.attributes[scene.attributeCorners[0][2]].color, glm::vec4(1));
}

/// A mask, red, green and blue for each vertex, 64 vertices a line at most.
TEST(ObjGeometry, PaintOfZBrushIsColoursOfVertices) {
    const std::string mesh = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
    for (const std::string paint :
         {"#MRGB FFff0080FFff0080ff00FF00\n", "#MRGB FFff0080FFff0080\n#MRGB ff00FF00\n"}) {
        const Scene scene = loadObjText(mesh + paint + "f 1 2 3\n");
        ASSERT_EQ(scene.attributeCorners.size(), 1u);
        const glm::vec4 color = scene.attributes[scene.attributeCorners[0][1]].color;
        EXPECT_EQ(color.x, 1);
        EXPECT_EQ(color.y, 0);
        EXPECT_NEAR(color.z, 0.215861, 1e-5); // ((128 / 255 + 0.055) / 1.055)^2.4
        EXPECT_EQ(scene.attributes[scene.attributeCorners[0][2]].color, glm::vec4(0, 1, 0, 1));
        EXPECT_THAT(scene.report.assumed, Contains(HasSubstr("ZBrush")));
    }
    EXPECT_THAT(loadObjText(mesh + "#MRGB 0x12345678\nf 1 2 3\n").report.forgiven,
                ElementsAre(HasSubstr("hexadecimal digits")));
    EXPECT_TRUE(loadObjText(mesh + "# MRGB FFff0080\nf 1 2 3\n").attributes.empty());
}

TEST(ObjGeometry, ObjectsAndGroupsAreInstances) {
    const Scene scene = loadObjText(kSquare + "f 1 2 3\no chair\nf 1 2 3\ng seat\nf 1 2 3\n"
                                              "g back\nf 1 2 3\ng seat\nf 1 3 4\no table\nf 1 2 3\n"
                                              "g empty\n");
    EXPECT_THAT(scene.instances,
                ElementsAre("default", "chair", "chair/seat", "chair/back", "table"));
    EXPECT_EQ(scene.triangles.size(), 6u);
    size_t ofSeat = 0;
    for (const Triangle& t : scene.triangles)
        ofSeat += t.instance == 2;
    EXPECT_EQ(ofSeat, 2u);
}

/// Each is a mesh with texture coordinates of its own, whichever of the file's it has.
TEST(ObjGeometry, GroupsHaveTextureCoordinatesInCommon) {
    const Scene scene = loadObjText(kSquare + "vt 0.25 0.5\nvt 0.75 0.5\ng a\nf 1/1 2/1 3/2\n"
                                              "g b\nf 1/2 3/1 4/1\n");
    ASSERT_EQ(scene.triangles.size(), 2u);
    EXPECT_EQ(uvOf(scene, 0, 0).x, 0.25f);
    EXPECT_EQ(uvOf(scene, 0, 2).x, 0.75f);
    EXPECT_EQ(uvOf(scene, 1, 0).x, 0.75f);
    EXPECT_EQ(uvOf(scene, 1, 2).x, 0.25f);
}

TEST(ObjGeometry, LinesGoOnAfterABackslashAndEndInAnyWay) {
    const std::string face = "f 1 2 \\\n 3 \\\r\n 4";
    EXPECT_EQ(loadObjText(kSquare + face).triangles.size(), 2u);
    EXPECT_EQ(loadObjText("\xEF\xBB\xBFv 0 0 0\rv 1 0 0 # x\r\nv\t1  1 0\r# f 9 9 9\rf 1 2 3 #4")
                  .triangles.size(),
              1u);
    std::string utf16 = "\xFE\xFF";
    for (const char c : kSquare + "f 1 2 3")
        utf16 += std::string{'\0', c};
    EXPECT_EQ(loadObjText(utf16).triangles.size(), 1u);
}

/// Two faces at a right angle, which share the edge of vertices 1 and 2.
const std::string kFold = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 -1\n";

TEST(ObjGeometry, FacesOfASmoothingGroupShareNormals) {
    const Scene scene = loadObjText(kFold + "s 1\nf 1 2 3\nf 2 1 4\n");
    ASSERT_EQ(scene.triangles.size(), 2u);
    const Triangle& t = scene.triangles[0];
    for (int k = 0; k < 3; ++k) {
        const bool isOnEdge = scene.positions[t.corner[k]].y == 0;
        const glm::vec3 n = scene.normals.at(t.normals[k]);
        // By the angles of the corners, 90 and 90 or 45 and 45 degrees, both faces count the same.
        EXPECT_NEAR(n.z, isOnEdge ? std::sqrt(0.5) : 1.0, 1e-3);
        EXPECT_NEAR(std::abs(n.y), isOnEdge ? std::sqrt(0.5) : 0.0, 1e-3);
    }
}

/// At the corner of 90 and of 45 degrees the first face counts twice as much.
TEST(ObjGeometry, NormalsOfAGroupAreWeightedByAngles) {
    const Scene scene = loadObjText("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 -1\ns 1\nf 1 2 3\nf 1 4 2\n");
    const Triangle& t = scene.triangles.at(0);
    for (int k = 0; k < 3; ++k) {
        if (scene.positions[t.corner[k]] != glm::vec3(0)) continue;
        const glm::vec3 n = scene.normals.at(t.normals[k]);
        EXPECT_NEAR(n.z, 2 / std::sqrt(5.0), 1e-3);
        EXPECT_NEAR(n.y, -1 / std::sqrt(5.0), 1e-3);
        return;
    }
    ADD_FAILURE() << "no corner at the origin";
}

/// Faces behind `s off` take no part in the group before.
TEST(ObjGeometry, SmoothingIsSwitchedOff) {
    const Scene scene = loadObjText(kFold + "s 1\nf 1 2 3\ns off\nf 2 1 4\n");
    for (const Triangle& t : scene.triangles)
        EXPECT_EQ(t.normals[0], kNoNormals);
}

TEST(ObjGeometry, ACornerTwiceInARowOfASmoothFaceIsNoFault) {
    EXPECT_EQ(loadObjText(kFold + "s 1\nf 1 1 2 3\n").triangles.size(), 1u);
}

TEST(ObjGeometry, BetweenSmoothingGroupsIsACrease) {
    const Scene scene = loadObjText(kFold + "s 1\nf 1 2 3\ns 2\nf 2 1 4\n");
    for (const Triangle& t : scene.triangles)
        EXPECT_EQ(t.normals[0], kNoNormals); // that of the triangle, which needs none
    const Scene flat = loadObjText(kFold + "s off\nf 1 2 3\nf 2 1 4\n");
    EXPECT_EQ(flat.triangles.at(0).normals[0], kNoNormals);
}

TEST(ObjGeometry, ColoursAboveOneAreFractionsOf255) {
    const Scene scene =
        loadObjText("v 0 0 0 255 0 51\nv 1 0 0 255 0 51\nv 1 1 0 255 0 51\nf 1 2 3\n");
    const glm::vec4 color = scene.attributes.at(0).color;
    EXPECT_EQ(color.x, 1);
    EXPECT_EQ(color.y, 0);
    EXPECT_NEAR(color.z, 0.0331, 1e-4); // IEC 61966-2-1 of 0.2
    EXPECT_THAT(scene.report.forgiven, Contains(HasSubstr("fractions of 255")));
}

TEST(ObjGeometry, NormalsThatAreNoNumbersShadeFlat) {
    for (const char* normal : {"nan nan nan", "-1.#IND 0 0", "1.#QNAN 0 0"}) {
        const Scene scene = loadObjText(kSquare + "vn " + normal + "\nf 1//1 2//1 3//1\n");
        EXPECT_EQ(scene.triangles.at(0).normals[0], kNoNormals) << normal;
        EXPECT_THAT(scene.report.forgiven, Contains(HasSubstr("shaded flat"))) << normal;
    }
}

TEST(ObjGeometry, WhatIsNotReadIsReported) {
    const Scene scene = loadObjText(kSquare + "s 1\ns off\nl 1 2\np 1\nvp 0 0\nf 1 2 3\nhello\n");
    EXPECT_THAT(scene.report.ignored, Contains(HasSubstr("2 lines and points")));
    EXPECT_THAT(scene.report.ignored, Contains(HasSubstr("1 'vp'")));
    EXPECT_THAT(scene.report.forgiven, Contains(HasSubstr("a.obj:11: <hello>: is no statement")));
    EXPECT_EQ(scene.lights.size(), 1u); // the default one
}

TEST(ObjGeometry, FacesHaveNormalsAndTextureCoordinatesEverywhereOrNowhere) {
    const Scene scene =
        loadObjText(kSquare + "vt 0 0\nvn 0 0.6 0.8\nf 1/1/1 2//1 3/1/1\nf 1/1/1 2/1 3/1/1\n");
    EXPECT_EQ(scene.triangles[0].normals[0], 0u);
    EXPECT_EQ(scene.attributeCorners[0][0], kNoAttributes);
    EXPECT_EQ(scene.triangles[1].normals[0], kNoNormals);
    EXPECT_EQ(scene.report.forgiven.size(), 2u);
}

TEST(ObjGeometry, ToldByContent) {
    EXPECT_TRUE(looksLikeObj("# comment\nmtllib a.mtl\nv 0 0 0\nf 1 1"));
    EXPECT_FALSE(looksLikeObj("g\nusemtl x\n"));
    EXPECT_FALSE(looksLikeObj("<COLLADA>\nv 0 0 0\n"));
    EXPECT_FALSE(looksLikeObj(""));
}

} // namespace
} // namespace stromboli::test
