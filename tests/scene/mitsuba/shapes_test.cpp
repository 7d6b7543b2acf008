// Shapes where the file puts them.

#include "scene/build/surface_mesh.hpp"
#include "scene/mitsuba/solids.hpp"
#include "scene/model/surface_lookup.hpp"
#include "tests/scene/mitsuba/mitsuba_text.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace stromboli::test {
namespace {

using testing::HasSubstr;

double areaOfShape(const Scene& scene) {
    double area = 0;
    for (const Triangle& t : scene.triangles)
        area += 0.5 * glm::length(glm::cross(
                          glm::dvec3(scene.positions[t.corner[1]] - scene.positions[t.corner[0]]),
                          glm::dvec3(scene.positions[t.corner[2]] - scene.positions[t.corner[0]])));
    return area;
}

Scene loadShape(const std::string& type, const std::string& inside = "") {
    return loadInside(fmt::format("<shape type=\"{}\">{}</shape>", type, inside));
}

TEST(MitsubaShapes, HaveTheirAreas) {
    constexpr double kPi = std::numbers::pi;
    EXPECT_DOUBLE_EQ(areaOfShape(loadShape("rectangle")), 4);
    EXPECT_DOUBLE_EQ(areaOfShape(loadShape("cube")), 24);
    // A circle of n sides has sin(2 pi / n) / (2 pi / n) of the area.
    EXPECT_NEAR(areaOfShape(loadShape("disk")), kPi, kPi * 1.1e-4);
    EXPECT_NEAR(areaOfShape(loadShape("cylinder")), 2 * kPi, 2 * kPi * 1e-4);
    const std::string stretched = "<transform name=\"to_world\"><scale x=\"2\" y=\"2\" z=\"2.01\"/>"
                                  "</transform>";
    EXPECT_NEAR(areaOfShape(loadShape("sphere", stretched)), 16 * kPi, 16 * kPi * 5e-3);
    EXPECT_EQ(loadShape("sphere").triangles.size(), 0u);
}

/// Distances from a ball of radius 0.3 at (0.4, 0.5, 0.6), for 20 x 25 x 30 places of the unit
/// cube.
std::string distancesFromBall(double radius) {
    std::string bytes = "VOL\x03";
    const auto add = [&](auto value) {
        bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
    };
    add(int32_t(1));
    const glm::ivec3 size(20, 25, 30);
    for (const int axis : {0, 1, 2})
        add(int32_t(size[axis]));
    add(int32_t(1));
    for (const float corner : {0.0f, 0.0f, 0.0f, 1.0f, 1.0f, 1.0f})
        add(corner);
    for (int z = 0; z < size.z; ++z)
        for (int y = 0; y < size.y; ++y)
            for (int x = 0; x < size.x; ++x) {
                const glm::dvec3 place = glm::dvec3(x, y, z) / glm::dvec3(size - 1);
                add(float(glm::distance(place, {0.4, 0.5, 0.6}) - radius));
            }
    return bytes;
}

TEST(MitsubaShapes, GridsOfDistancesHaveASurface) {
    const std::string file = writeFile("ball.vol", distancesFromBall(0.3)).filename().string();
    const std::string named = "<string name=\"filename\" value=\"" + file + "\"/>";
    const Scene scene = loadShape("sdfgrid", named);
    EXPECT_TRUE(scene.report.forgiven.empty());
    const double area = 4 * std::numbers::pi * 0.3 * 0.3;
    EXPECT_NEAR(areaOfShape(scene), area, 0.02 * area);
    const glm::dvec3 middle(0.4, 0.5, 0.6);
    glm::dvec3 sum(0.0);
    // A line between two distances is off by the square of its length / (8 radius).
    const double most = (1 / (19.0 * 19) + 1 / (24.0 * 24) + 1 / (29.0 * 29)) / (8 * 0.3);
    double flux = 0; // of the place, whose divergence is 3
    for (const Triangle& t : scene.triangles) {
        glm::dvec3 corners[3];
        for (size_t i = 0; i < 3; ++i) {
            corners[i] = glm::dvec3(scene.positions[t.corner[i]]) + scene.origin - middle;
            EXPECT_NEAR(glm::length(corners[i]), 0.3, most);
        }
        const glm::dvec3 outwards =
            glm::cross(corners[1] - corners[0], corners[2] - corners[0]) / 2.0;
        sum += outwards;
        flux += glm::dot(outwards, corners[0]);
    }
    EXPECT_LT(glm::length(sum), 1e-5); // it is closed
    EXPECT_NEAR(flux / 3, 0.3 * area / 3, 0.02 * area);
    ASSERT_FALSE(scene.normals.empty());
    EXPECT_THAT(problemInside(rectangleOf("") +
                              "<shape type=\"sdfgrid\"><string name=\"filename\" value=\"" +
                              writeFile("none.vol", distancesFromBall(-1)).filename().string() +
                              "\"/></shape>"),
                HasSubstr("there is no surface"));
}

TEST(MitsubaShapes, FaceOutwards) {
    for (const char* type : {"cube", "sphere", "cylinder"}) {
        const Scene scene = loadShape(type, "<transform name=\"to_world\">"
                                            "<scale x=\"1\" y=\"2\" z=\"1\"/></transform>");
        ASSERT_FALSE(scene.triangles.empty());
        for (const Triangle& t : scene.triangles) {
            glm::vec3 middle(0.0f);
            for (const uint32_t corner : t.corner)
                middle += scene.positions[corner] / 3.0f;
            if (std::string(type) == "cylinder") middle.z = 0;
            ASSERT_GT(glm::dot(scene.geometricNormal(t), middle), 0) << type;
        }
    }
    EXPECT_EQ(loadShape("rectangle").geometricNormal(loadShape("rectangle").triangles[0]),
              glm::vec3(0, 0, 1));
    const Scene flipped = loadShape("rectangle", "<boolean name=\"flip_normals\" value=\"true\"/>");
    EXPECT_EQ(flipped.geometricNormal(flipped.triangles[0]), glm::vec3(0, 0, -1));
}

/// As Mitsuba 3.9 has them in 'vertex_positions' and 'vertex_texcoords'.
TEST(MitsubaShapes, CubesHaveMitsubasTextureCoordinates) {
    struct Face {
        glm::vec3 normal;
        std::array<glm::vec3, 4> at; ///< of (0, 1), (1, 1), (1, 0) and (0, 0)
    };
    const std::array<Face, 6> faces = {
        {{{0, -1, 0}, {{{1, -1, -1}, {1, -1, 1}, {-1, -1, 1}, {-1, -1, -1}}}},
         {{0, 1, 0}, {{{1, 1, -1}, {-1, 1, -1}, {-1, 1, 1}, {1, 1, 1}}}},
         {{1, 0, 0}, {{{1, -1, -1}, {1, 1, -1}, {1, 1, 1}, {1, -1, 1}}}},
         {{0, 0, 1}, {{{1, -1, 1}, {1, 1, 1}, {-1, 1, 1}, {-1, -1, 1}}}},
         {{-1, 0, 0}, {{{-1, -1, 1}, {-1, 1, 1}, {-1, 1, -1}, {-1, -1, -1}}}},
         {{0, 0, -1}, {{{1, 1, -1}, {1, -1, -1}, {-1, -1, -1}, {-1, 1, -1}}}}}};
    const std::array<glm::vec2, 4> uvs = {{{0, 1}, {1, 1}, {1, 0}, {0, 0}}};
    const build::Mesh cube = mitsuba::cubeMesh();
    ASSERT_EQ(cube.parts.front().size(), 12u);
    for (const build::MeshTriangle& t : cube.parts.front()) {
        const auto position = [&](const build::Corner& c) {
            return glm::vec3(cube.positions[c.position]);
        };
        const glm::vec3 a = position(t[0]);
        const glm::vec3 normal = glm::normalize(glm::cross(position(t[1]) - a, position(t[2]) - a));
        const auto face = std::ranges::find(faces, normal, &Face::normal);
        ASSERT_NE(face, faces.end());
        for (const build::Corner& c : t) {
            const auto at = std::ranges::find(face->at, position(c));
            ASSERT_NE(at, face->at.end());
            EXPECT_EQ(cube.attributes[c.attributes].uv[0], uvs[size_t(at - face->at.begin())]);
        }
    }
}

/// Round the axis from where its frame begins (Duff et al. 2017), as Mitsuba has it.
TEST(MitsubaShapes, CylindersBeginWhereMitsubasDo) {
    const glm::dvec3 from(-1, 0.6, 0), axis = glm::normalize(glm::dvec3(2, 0.6, 0));
    const build::Mesh cylinder = mitsuba::cylinderMesh(from, {1, 1.2, 0}, 0.5, false);
    const glm::dvec3 first = (cylinder.positions.at(0) - from) / 0.5;
    EXPECT_EQ(cylinder.attributes.at(0).uv[0], glm::vec2(0));
    EXPECT_NEAR(first.x, 1 - axis.x * axis.x, 1e-12);
    EXPECT_NEAR(first.y, -axis.x * axis.y, 1e-12);
    EXPECT_NEAR(first.z, -axis.x, 1e-12);
}

TEST(MitsubaShapes, SpheresStayTrueWhereTheyCan) {
    const Scene scene = loadShape("sphere", "<point name=\"center\" x=\"1\" y=\"2\" z=\"3\"/>"
                                            "<float name=\"radius\" value=\"2\"/>"
                                            "<transform name=\"to_world\"><scale value=\"3\"/>"
                                            "</transform>");
    EXPECT_EQ(scene.spheres.at(0).center, glm::vec3(3, 6, 9));
    EXPECT_EQ(scene.spheres.at(0).radius, 6);
    EXPECT_THAT(
        problemInside("<shape type=\"sphere\"><float name=\"radius\" value=\"0\"/></shape>"),
        HasSubstr("'radius' is 0, expected more"));
}

TEST(MitsubaShapes, GroupsShowWhereTheyAreInstanced) {
    const std::string group = "<shape type=\"shapegroup\" id=\"g\"><shape type=\"sphere\"/>"
                              "<shape type=\"rectangle\"/></shape>";
    EXPECT_TRUE(loadInside(group).spheres.empty());
    const Scene scene =
        loadInside(group + "<shape type=\"instance\"><ref id=\"g\"/></shape>"
                           "<shape type=\"instance\"><ref id=\"g\"/><transform name=\"to_world\">"
                           "<translate x=\"5\"/></transform></shape>");
    ASSERT_EQ(scene.spheres.size(), 2u);
    EXPECT_EQ(scene.spheres[1].center.x, 5);
    EXPECT_EQ(scene.triangles.size(), 4u);
    EXPECT_THAT(problemInside("<shape type=\"instance\"/>"),
                HasSubstr("has no shape group to show"));
}

TEST(MitsubaShapes, MeshesComeFromFiles) {
    writeFile("roof.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0.5 0 1\n"
                          "f 1 2 3 4\nf 1 5 2\n");
    const std::string file = "<string name=\"filename\" value=\"roof.obj\"/>";
    const Scene smooth = loadShape("obj", file);
    EXPECT_EQ(smooth.triangles.size(), 3u);
    EXPECT_NE(smooth.triangles[0].normals[0], kNoNormals);
    const Scene flat = loadShape("obj", file + "<boolean name=\"face_normals\" value=\"true\"/>");
    EXPECT_EQ(flat.triangles[0].normals[0], kNoNormals);
    EXPECT_THAT(problemInside("<shape type=\"ply\"/>"), HasSubstr("has no string 'filename'"));
    EXPECT_THAT(problemInside("<shape type=\"ply\"><string name=\"filename\" value=\"no.ply\"/>"
                              "</shape>"),
                HasSubstr("2: <shape>: names the file 'no.ply', which is not there"));
}

TEST(MitsubaShapes, VertexColorsAreAnAttribute) {
    writeFile("painted.ply",
              "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\n"
              "property float z\nproperty float color_0\nproperty float color_1\n"
              "property float color_2\nelement face 1\nproperty list uchar int vertex_indices\n"
              "end_header\n0 0 0 1 0 0\n1 0 0 0 1 0\n0 1 0 0 0 1\n3 0 1 2\n");
    const std::string mesh = "<string name=\"filename\" value=\"painted.ply\"/>";
    const std::string bsdf = "<bsdf type=\"diffuse\"><texture type=\"mesh_attribute\" "
                             "name=\"reflectance\"><string name=\"name\" value=\"vertex_color\"/>"
                             "</texture></bsdf>";
    const Scene painted = loadShape("ply", mesh + bsdf);
    ASSERT_EQ(painted.attributeCorners.size(), 1u);
    EXPECT_EQ(painted.attributes[painted.attributeCorners[0][1]].color, glm::vec4(0, 1, 0, 1));
    EXPECT_TRUE(loadShape("ply", mesh).attributeCorners.empty()); // nothing looks at them
    EXPECT_THAT(problemInside("<shape type=\"cube\">" + bsdf + "</shape>"),
                HasSubstr("expected a mesh from a file"));
}

/// Attributes of a quad, which is cut in two, and a triangle that shares corners with it.
TEST(MitsubaShapes, FaceColorsAreAnAttributeOfPlyFiles) {
    writeFile("tiles.ply",
              "ply\nformat ascii 1.0\nelement vertex 5\nproperty float x\nproperty float y\n"
              "property float z\nelement face 2\nproperty list uchar int vertex_indices\n"
              "property float r\nproperty float g\nproperty float b\n"
              "end_header\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n2 0 0\n"
              "4 0 1 2 3 0.25 0.5 0.75\n3 1 4 2 1 0 0\n");
    const std::string mesh = "<string name=\"filename\" value=\"tiles.ply\"/>";
    const auto bsdf = [](const std::string& name) {
        return "<bsdf type=\"diffuse\"><texture type=\"mesh_attribute\" name=\"reflectance\">"
               "<string name=\"name\" value=\"" +
               name + "\"/></texture></bsdf>";
    };
    const Scene tiles = loadShape("ply", mesh + bsdf("face_color"));
    ASSERT_EQ(tiles.attributeCorners.size(), 3u);
    for (size_t i = 0; i < 3; ++i)
        for (const uint32_t corner : tiles.attributeCorners[i])
            EXPECT_EQ(tiles.attributes[corner].color,
                      i < 2 ? glm::vec4(0.25, 0.5, 0.75, 1) : glm::vec4(1, 0, 0, 1))
                << i;
    const auto problemOf = [&](const std::string& type, const std::string& inside) {
        return problemInside("<shape type=\"" + type + "\">" + inside + "</shape>");
    };
    EXPECT_THAT(problemOf("ply", mesh + bsdf("vertex_density")),
                HasSubstr("has a bsdf of vertex_density, and its file has no such attribute"));
    EXPECT_THAT(problemOf("ply", mesh + bsdf("face_density")),
                HasSubstr("has a bsdf of face_density, and its file has no such attribute"));
    EXPECT_THAT(problemOf("ply", mesh + bsdf("density")),
                HasSubstr("'name' is 'density', expected vertex_... or face_..."));
    EXPECT_THAT(problemOf("cube", bsdf("face_color")), HasSubstr("expected a mesh from a file"));
}

/// A texture that is linear between corners: of two triangles, in a parameter that has no colours
/// of corners, by numbers of vertices and of faces.
TEST(MitsubaShapes, MeshAttributesPaintAnyTexture) {
    writeFile("worn.ply",
              "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
              "property float z\nproperty float rough_x\nproperty float tint_r\n"
              "property float tint_g\nproperty float tint_b\nelement face 2\n"
              "property list uchar int vertex_indices\nproperty float share_0\nend_header\n"
              "0 0 0 0.25 1 0 0\n1 0 0 0.5 0 1 0\n1 1 0 1 0 0 1\n0 1 0 0.125 1 1 1\n"
              "3 0 1 2 0.75\n3 0 2 3 0.5\n");
    const std::string mesh = "<string name=\"filename\" value=\"worn.ply\"/>";
    const auto painted = [](const std::string& parameter, const std::string& name) {
        return "<texture type=\"mesh_attribute\" name=\"" + parameter +
               "\"><string name=\"name\" value=\"" + name + "\"/></texture>";
    };
    const Scene scene =
        loadShape("ply", mesh + "<bsdf type=\"blendbsdf\">" + painted("weight", "face_share") +
                             "<bsdf type=\"principled\">" + painted("roughness", "vertex_rough") +
                             painted("base_color", "vertex_tint_color") +
                             "</bsdf><bsdf type=\"plastic\"/></bsdf><emitter type=\"area\">" +
                             painted("radiance", "vertex_tint_color") + "</emitter>");
    const double rough[2][3] = {{0.25, 0.5, 1}, {0.25, 1, 0.125}};
    const glm::dvec3 tint[2][3] = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}},
                                   {{1, 0, 0}, {0, 0, 1}, {1, 1, 1}}};
    const double share[2] = {0.75, 0.5};
    const double bs[][2] = {{0, 0}, {1, 0}, {0, 1}, {0.5, 0.5}, {0.25, 0.5}, {0.1, 0.2}};
    for (uint32_t t = 0; t < 2; ++t) {
        const Material& m = scene.materials.at(scene.triangles.at(t).material);
        for (const auto& [b1, b2] : bs) {
            const PointAttributes at = attributesAt(scene, t, b1, b2);
            const double weights[3] = {1 - b1 - b2, b1, b2};
            double expected = 0;
            glm::dvec3 color(0);
            for (int k = 0; k < 3; ++k)
                expected += weights[k] * rough[t][k], color += weights[k] * tint[t][k];
            const auto found = [&](TextureSlot slot) {
                return lookUp(scene, *textureIn(m, slot), at);
            };
            // Half floats, and where floats have the coordinates.
            EXPECT_NEAR(found(TextureSlot::MetallicRoughness).y, expected, 1e-3);
            EXPECT_NEAR(otherShareAt(scene, m, at), share[t], 1e-3);
            EXPECT_LT(glm::distance(glm::dvec3(found(TextureSlot::BaseColor)), color), 1e-3);
            EXPECT_EQ(at.color, glm::dvec4(1)) << "which plastic would have too";
            EXPECT_LT(glm::distance(glm::dvec3(found(TextureSlot::Emission)), color), 1e-3);
        }
    }
    EXPECT_THAT(problemInside("<shape type=\"cube\"><bsdf type=\"principled\">" +
                              painted("roughness", "vertex_rough") + "</bsdf></shape>"),
                HasSubstr("expected a mesh from a file that has it"));
    EXPECT_THAT(problemInside("<shape type=\"ply\">" + mesh + "<bsdf type=\"bumpmap\">" +
                              painted("", "vertex_rough") +
                              "<bsdf type=\"diffuse\"/></bsdf></shape>"),
                HasSubstr("that is no picture, expected one of heights"));
}

/// Corner by corner, whatever shares them: the mean of two faces at right angles.
TEST(MitsubaShapes, NormalsAreWeighedByAngles) {
    build::Mesh mesh;
    mesh.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    mesh.parts = {{{{{0}, {1}, {2}}}, {{{0}, {2}, {3}}}}};
    build::computeNormals(mesh);
    const glm::dvec3 shared = glm::normalize(mesh.normals[mesh.parts[0][0][0].normal]);
    EXPECT_NEAR(glm::distance(shared, glm::normalize(glm::dvec3(1, 0, 1))), 0, 1e-12);
    EXPECT_EQ(mesh.parts[0][0][0].normal, mesh.parts[0][1][0].normal);
}

} // namespace
} // namespace stromboli::test
