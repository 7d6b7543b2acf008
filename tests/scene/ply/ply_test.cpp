// What PLY files may state.

#include "tests/scene/ply/ply_text.hpp"

namespace stromboli::test {
namespace {

using testing::Contains;
using testing::HasSubstr;

TEST(Ply, Ascii) {
    const Scene scene = loadPlyBytes(plyHeader("ascii") + kPlySquare + "4 0 1 2 3\n");
    EXPECT_EQ(scene.triangles.size(), 2u);
    EXPECT_THAT(scene.instances, testing::ElementsAre("p"));
    EXPECT_EQ(scene.materials.at(0).kind, MaterialKind::Diffuse);
    EXPECT_EQ(scene.materials.at(0).albedo, glm::vec3(0.5f));
    EXPECT_TRUE(scene.attributeCorners.empty());
    EXPECT_EQ(scene.lights.size(), 1u); // the default one
}

TEST(Ply, BothBinaryOrders) {
    for (const bool big : {false, true}) {
        std::string bytes =
            plyHeader(big ? "binary_big_endian" : "binary_little_endian", "property short q\n",
                      "element face 1\nproperty double quality\n"
                      "property list ushort uint vertex_index\n");
        const float corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0.5f}};
        for (const auto& corner : corners) {
            for (const float x : corner)
                bytes += plyBytes(x, big);
            bytes += plyBytes(int16_t(-2), big);
        }
        bytes += plyBytes(1.5, big) + plyBytes(uint16_t(3), big);
        for (const uint32_t index : {0u, 1u, 3u})
            bytes += plyBytes(index, big);
        const Scene scene = loadPlyBytes(bytes);
        ASSERT_EQ(scene.triangles.size(), 1u);
        EXPECT_EQ(scene.positions[scene.triangles[0].corner[2]], glm::vec3(0, 1, 0.5f));
        EXPECT_THAT(scene.report.ignored, Contains(HasSubstr("properties of vertices")));
        EXPECT_THAT(scene.report.ignored, Contains(HasSubstr("properties of faces")));
    }
}

TEST(Ply, NormalsTextureCoordinatesAndColours) {
    const std::string row = " 0 0.6 0.8 0.25 0.125 255 0 128 51\n";
    for (const std::string uv : {"s t", "u v", "texture_u texture_v"}) {
        const std::string u = uv.substr(0, uv.find(' ')), v = uv.substr(uv.find(' ') + 1);
        const Scene scene = loadPlyBytes(
            plyHeader("ascii", "property float nx\nproperty float ny\nproperty float nz\n"
                               "property float " +
                                   u + "\nproperty double " + v +
                                   "\nproperty uchar red\nproperty uchar green\n"
                                   "property uchar blue\nproperty uchar alpha\n") +
            "0 0 0" + row + "1 0 0" + row + "1 1 0" + row + "0 1 0" + row + "3 0 1 2\n");
        const VertexAttributes& a = scene.attributes.at(scene.attributeCorners.at(0)[0]);
        EXPECT_EQ(a.uv[0], glm::vec2(0.25f, 0.875f)); // v points up in the file
        EXPECT_EQ(a.color.x, 1);
        EXPECT_EQ(a.color.y, 0);
        EXPECT_NEAR(a.color.z, 0.215861, 1e-5); // ((128 / 255 + 0.055) / 1.055)^2.4
        EXPECT_FLOAT_EQ(a.color.w, 0.2f);
        EXPECT_EQ(scene.materials[0].albedo, glm::vec3(1));
        EXPECT_EQ(scene.materials[0].alphaMode, AlphaMode::Blend);
        EXPECT_NEAR(scene.normals.at(scene.triangles[0].normals[0]).z, 0.8, 1e-6);
    }
}

TEST(Ply, ColoursOfFaces) {
    const Scene scene = loadPlyBytes(
        plyHeader("ascii", "",
                  "element face 2\nproperty list uchar int vertex_indices\nproperty uchar red\n"
                  "property uchar green\nproperty uchar blue\n") +
        kPlySquare + "3 0 1 2 255 0 0\n3 0 2 3 0 255 0\n");
    ASSERT_EQ(scene.attributeCorners.size(), 2u);
    for (size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(scene.attributes.at(scene.attributeCorners[0][k]).color, glm::vec4(1, 0, 0, 1));
        EXPECT_EQ(scene.attributes.at(scene.attributeCorners[1][k]).color, glm::vec4(0, 1, 0, 1));
    }
    EXPECT_EQ(scene.materials.at(0).albedo, glm::vec3(1));
}

TEST(Ply, APictureThatIsNotThereIsSaid) {
    std::string text = plyHeader("ascii", "property float s\nproperty float t\n") +
                       "0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n4 0 1 2 3\n";
    text.replace(text.find("made by hand"), 12, "TextureFile none.png");
    const Scene scene = loadPlyBytes(text);
    EXPECT_EQ(scene.triangles.size(), 2u);
    EXPECT_THAT(scene.report.forgiven,
                testing::Contains(testing::HasSubstr("'none.png' is not in the file's folder")));
}

/// MeshLab writes two coordinates for each corner of a face; v points up in the file.
TEST(Ply, FacesHaveTextureCoordinatesOfTheirCorners) {
    const Scene scene =
        loadPlyBytes(plyHeader("ascii", "",
                               "element face 1\nproperty list uchar int vertex_indices\n"
                               "property list uchar float texcoord\n") +
                     kPlySquare + "3 0 1 2 6 0.25 0.125 1 0 0.5 0.75\n");
    ASSERT_EQ(scene.triangles.size(), 1u);
    const glm::vec2 expected[3] = {{0.25f, 0.875f}, {1, 1}, {0.5f, 0.25f}};
    for (int k = 0; k < 3; ++k)
        EXPECT_EQ(scene.attributes.at(scene.attributeCorners.at(0)[k]).uv[0], expected[k]);
}

/// Other numbers of them than two a corner are left out, and said.
TEST(Ply, TextureCoordinatesThatDoNotFitAreSaid) {
    const Scene scene =
        loadPlyBytes(plyHeader("ascii", "",
                               "element face 1\nproperty list uchar int vertex_indices\n"
                               "property list uchar float texcoord\n") +
                     kPlySquare + "3 0 1 2 4 0.25 0.125 1 0\n");
    EXPECT_EQ(scene.triangles.size(), 1u);
    EXPECT_THAT(scene.report.forgiven, Contains(HasSubstr("4 texture coordinates for 3 corners")));
}

TEST(Ply, ColoursAsFloatsAreLinear) {
    const std::string row = " 0.5 2 0\n"; // what is above 1 would reflect more than there is
    const Scene scene =
        loadPlyBytes(plyHeader("ascii", "property float r\nproperty float g\nproperty float b\n") +
                     "0 0 0" + row + "1 0 0" + row + "1 1 0" + row + "0 1 0" + row + "3 0 1 2\n");
    EXPECT_EQ(scene.attributes.at(0).color, glm::vec4(0.5f, 1, 0, 1));
    EXPECT_THAT(scene.report.warnings, testing::Contains(testing::HasSubstr("clamped")));
    EXPECT_EQ(scene.materials[0].alphaMode, AlphaMode::Opaque);
}

TEST(Ply, StripsAlternateAndStartAgain) {
    const Scene scene = loadPlyBytes(
        plyHeader("ascii", "", "element tristrips 1\nproperty list int int vertex_indices\n") +
        kPlySquare + "9 0 1 3 2 -1 2 1 0 -1\n");
    ASSERT_EQ(scene.triangles.size(), 3u);
    for (size_t t = 0; t < 2; ++t) // 0 1 3 and 3 1 2: both face z
        EXPECT_GT(scene.geometricNormal(scene.triangles[t]).z, 0);
    EXPECT_LT(scene.geometricNormal(scene.triangles[2]).z, 0);
}

TEST(Ply, OtherElementsAreSkippedWithTheirLists) {
    const Scene scene = loadPlyBytes(
        "ply\nformat ascii 1.0\nelement camera 2\nproperty float f\nproperty list uchar float l\n"
        "property int n\nelement nothing 4000000000000000000\nelement face 1\n"
        "property list uchar int vertex_indices\nelement vertex 3\nproperty int8 z\n"
        "property int16 y\nproperty float64 x\nend_header\n1 3 1 2 3 nan\n2 0 7\n3 0 1 2\n"
        "0 0 0\n0 0 1\n0 1 0\n");
    EXPECT_EQ(scene.triangles.size(), 1u);
    EXPECT_THAT(scene.report.ignored, Contains(HasSubstr("2 element 'camera'")));
    EXPECT_EQ(scene.positions[1], glm::vec3(1, 0, 0));
}

TEST(Ply, LinesEndInAnyWay) {
    const std::string text = plyHeader("ascii") + kPlySquare + "4 0 1 2 3\n";
    for (const std::string newline : {"\r\n", "\r"}) {
        std::string other;
        for (const char c : text)
            other += c == '\n' ? newline : std::string{c};
        EXPECT_EQ(loadPlyBytes(other).triangles.size(), 2u);
        EXPECT_TRUE(looksLikePly(other));
    }
    EXPECT_FALSE(looksLikePly("plywood\n"));
}

/// Clouds of points leave nothing to show.
TEST(Ply, VerticesWithoutFacesAreAnError) {
    const std::string expected = "p.ply: has 4 vertices and no faces: expected an element 'face'";
    EXPECT_THAT(plyErrorOf(plyHeader("ascii", "", "") + kPlySquare), HasSubstr(expected));
    EXPECT_THAT(plyErrorOf(plyHeader("ascii", "", "element face 0\nproperty list uchar int x\n") +
                           kPlySquare),
                HasSubstr(expected));
}

/// Other programs than those of Stanford write names as they like.
TEST(Ply, NamesMayHaveOtherCapitals) {
    const Scene scene = loadPlyBytes(
        "ply\nformat ascii 1.0\nelement Vertex 3\nproperty float X\nproperty float Y\n"
        "property float Z\nproperty float U\nproperty float V\nproperty uchar Red\n"
        "property uchar Green\nproperty uchar Blue\nelement Face 1\n"
        "property list uchar int64 Indices\nend_header\n0 0 0 0 0 255 0 0\n1 0 0 1 0 255 0 0\n"
        "1 1 0 1 0.25 255 0 0\n3 0 1 2\n");
    ASSERT_EQ(scene.triangles.size(), 1u);
    EXPECT_EQ(scene.attributes.at(2).color, glm::vec4(1, 0, 0, 1));
    EXPECT_EQ(scene.attributes.at(2).uv[0], glm::vec2(1, 0.75f));
}

/// Programs that know one type of numbers only write bytes in it.
TEST(Ply, ColoursOfAnyTypeMayBeBytes) {
    for (const std::string type : {"int", "short", "float", "int64"}) {
        std::string more;
        for (const char* name : {"red", "green", "blue", "alpha"})
            more += "property " + type + " " + name + "\n";
        std::string body;
        for (const char* corner : {"0 0 0", "1 0 0", "1 1 0", "0 1 0"})
            body += std::string(corner) + " 255 0 128 51\n";
        const Scene scene = loadPlyBytes(plyHeader("ascii", more) + body + "4 0 1 2 3\n");
        const glm::vec4 color = scene.attributes.at(0).color;
        EXPECT_FLOAT_EQ(color.x, 1) << type;
        EXPECT_EQ(color.y, 0) << type;
        EXPECT_NEAR(color.z, 0.215861, 1e-5) << type; // ((128 / 255 + 0.055) / 1.055)^2.4
        EXPECT_FLOAT_EQ(color.w, 0.2f) << type;
        const bool isFloat = type == "float";
        EXPECT_EQ(scene.report.forgiven.size(), isFloat ? 1u : 0u) << type;
        if (isFloat) continue;
        EXPECT_THAT(scene.report.assumed, Contains(HasSubstr("of 255"))) << type;
    }
}

/// MeshLab writes the number of a picture for each face, -1 for none.
TEST(Ply, FacesHaveThePicturesOfTheirNumbers) {
    std::string text = plyHeader("ascii", "property float s\nproperty float t\n",
                                 "element face 3\nproperty list uchar int vertex_indices\n"
                                 "property int texnumber\n") +
                       "0 0 0 0 0\n1 0 0 1 0\n1 1 0 1 1\n0 1 0 0 1\n"
                       "3 0 1 2 1\n3 0 2 3 -1\n3 0 1 3 0\n";
    text.replace(text.find("comment made by hand"), 20,
                 "obj_info TEXTUREFILE: \"a.png\"\ncomment TextureFile b.png");
    const Scene scene = loadPlyBytes(text);
    ASSERT_EQ(scene.triangles.size(), 3u);
    EXPECT_EQ(scene.materials.size(), 3u);
    EXPECT_NE(scene.triangles[0].material, scene.triangles[1].material);
    // Neither picture is there: each is looked for.
    EXPECT_THAT(scene.report.forgiven, Contains(HasSubstr("'b.png' is not in the file's folder")));
    EXPECT_THAT(scene.report.forgiven, testing::Not(Contains(HasSubstr("first picture"))));
}

TEST(Ply, AFileThatEndsTooEarlyIsShownAsFarAsItGoes) {
    for (const char* faces : {"element face 3\n", "element face 3000000\n"}) {
        const std::string list = "property list uchar int vertex_indices\n";
        const Scene scene =
            loadPlyBytes(plyHeader("ascii", "", faces + list) + kPlySquare + "3 0 1 2\n3 0 2");
        EXPECT_EQ(scene.triangles.size(), 1u);
        EXPECT_THAT(scene.report.forgiven, testing::ElementsAre(HasSubstr("it is left out")));
        std::string binary = plyHeader("binary_little_endian", "", faces + list);
        for (const float x : {0.f, 0.f, 0.f, 1.f, 0.f, 0.f, 1.f, 1.f, 0.f, 0.f, 1.f, 0.f})
            binary += plyBytes(x, false);
        for (const int32_t corner : {0, 1, 2})
            binary += (corner == 0 ? "\x03" : "") + plyBytes(corner, false);
        EXPECT_EQ(loadPlyBytes(binary + "\x03" + std::string(7, '\0')).triangles.size(), 1u);
    }
}

TEST(Ply, BeginsWithAByteOrderMarkOrHasMixedEndsOfLines) {
    const std::string text = plyHeader("ascii") + kPlySquare + "4 0 1 2 3\n";
    EXPECT_EQ(loadPlyBytes("\xEF\xBB\xBF" + text).triangles.size(), 2u);
    std::string mixed = text;
    mixed.replace(mixed.find('\n'), 1, "\r\n");
    EXPECT_EQ(loadPlyBytes(mixed).triangles.size(), 2u);
}

TEST(Ply, WhatIsForgiven) {
    const Scene scene = loadPlyBytes(plyHeader("ascii", "made by me\n") + "0 0 0 7 7\n1 0 0\n" +
                                     "1 1 0\n0 1 0\n4 0 1 2 3\n");
    EXPECT_EQ(scene.triangles.size(), 2u);
    EXPECT_THAT(scene.report.forgiven, Contains(HasSubstr("p.ply:8: 'made' is no keyword")));
    EXPECT_THAT(scene.report.forgiven,
                Contains(HasSubstr("p.ply:12: <vertex[0]>: the line has more numbers")));
}

} // namespace
} // namespace stromboli::test
