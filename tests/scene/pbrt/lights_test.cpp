// Lights of both versions, with their units.

#include "scene/pbrt/environment.hpp"
#include "tests/scene/pbrt/pbrt_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <numbers>

namespace stromboli::test {
namespace {

using std::numbers::pi;
using testing::HasSubstr;

Light lightV4(const std::string& text) {
    return loadV4("LightSource " + text + " " + kTriangle).lights.at(0);
}

Light lightV3(const std::string& text) {
    return loadV3("LightSource " + text + " " + kTriangle).lights.at(0);
}

void expectNear(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 1e-4) {
    for (const int i : {0, 1, 2})
        EXPECT_NEAR(a[i], b[i], tolerance) << i;
}

double luminance(const glm::vec3& rgb) {
    return glm::dot(glm::dvec3(rgb), glm::dvec3(0.212671, 0.715160, 0.072169));
}

TEST(PbrtPoint, IsAnIntensity) {
    const Light light =
        lightV4("\"point\" \"rgb I\" [1 2 3] \"float scale\" 2 \"point3 from\" [1 2 "
                "3]");
    EXPECT_EQ(light.kind, LightKind::Point);
    expectNear(light.color, {2, 4, 6});
    expectNear(light.position, {1, 2, 3});
    EXPECT_EQ(light.quadraticAttenuation, 1);
    EXPECT_EQ(light.constantAttenuation, 0);
    expectNear(lightV4("\"point\" \"float power\" 100").color, glm::dvec3(100 / (4 * pi)));
    EXPECT_NEAR(luminance(lightV4("\"point\" \"blackbody I\" 3000").color), 1, 1e-3);
    EXPECT_NEAR(luminance(lightV4("\"point\" \"spectrum I\" [400 3 700 9]").color), 1, 1e-3);
    expectNear(lightV4("\"point\" \"spectrum I\" \"stdillum-D65\"").color, glm::dvec3(1), 2e-3);
    // In pbrt-v3 a spectrum is what it is: 1 at all wavelengths has the luminance 1.
    EXPECT_NEAR(luminance(lightV3("\"point\" \"spectrum I\" [300 2 900 2]").color), 2, 1e-2);
    EXPECT_NEAR(luminance(lightV3("\"point\" \"blackbody I\" [6500 2]").color), 1.8, 0.2);
}

TEST(PbrtDistant, ComesFromASide) {
    const Light light = lightV4("\"distant\" \"point3 from\" [0 5 0] \"point3 to\" [0 0 0] \"float "
                                "illuminance\" 7");
    EXPECT_EQ(light.kind, LightKind::Directional);
    expectNear(light.direction, {0, -1, 0});
    expectNear(light.color, glm::dvec3(7));
    expectNear(lightV3("\"distant\" \"rgb L\" [2 2 2]").direction, {0, 0, 1});
}

/// What a lamp's picture has along its direction and at an angle beside it.
glm::dvec3 intensityOf(const Scene& scene, double degrees) {
    const Light& light = scene.lights.at(0);
    const double t = std::tan(degrees * pi / 180) * glm::length(glm::dvec3(light.edgeX));
    const TextureImage& image = scene.images.at(scene.textures.at(light.picture->texture).image);
    const auto at = [&](double share) {
        return size_t(std::clamp(share, 0.0, 0.9999) * image.width);
    };
    const size_t texel = at(0.5) * image.width + at(0.5 + t);
    const double secant = 1 / std::cos(degrees * pi / 180);
    const uint32_t half = image.words.at(2 * texel) & 0xFFFF;
    // Positive half floats are in the order of their words; good for what is tested here.
    const double value = std::ldexp(1 + double(half & 0x3FF) / 1024, int(half >> 10) - 15);
    return half == 0 ? glm::dvec3(0) : glm::dvec3(light.color) * value * std::pow(secant, 3);
}

TEST(PbrtSpot, FallsOffAsItsVersionHasIt) {
    const std::string text =
        "LightSource \"spot\" \"rgb I\" [3 3 3] \"float coneangle\" 40 \"float "
        "conedeltaangle\" 20 " +
        std::string(kTriangle);
    const Scene v4 = loadV4(text), v3 = loadV3(text);
    EXPECT_EQ(v4.lights.at(0).kind, LightKind::Projector);
    expectNear(v4.lights.at(0).direction, {0, 0, 1});
    const double outer = std::cos(40 * pi / 180), inner = std::cos(20 * pi / 180);
    const double share = (std::cos(30 * pi / 180) - outer) / (inner - outer);
    EXPECT_NEAR(intensityOf(v4, 5).x, 3, 0.05);
    EXPECT_NEAR(intensityOf(v4, 30).x, 3 * share * share * (3 - 2 * share), 0.05);
    EXPECT_NEAR(intensityOf(v3, 30).x, 3 * std::pow(share, 4), 0.05);
    EXPECT_NEAR(intensityOf(v3, 39.9).x, 0, 0.01);
    // Wider than a picture across can be.
    EXPECT_GE(loadV4("LightSource \"spot\" \"float coneangle\" 100 " + std::string(kTriangle))
                  .lights.size(),
              5u);
    EXPECT_THAT(problemInV4("LightSource \"spot\" \"point3 to\" [0 0 0]"),
                HasSubstr("no direction"));
}

TEST(PbrtPictures, AreProjectedAndThrownAround) {
    const std::string name =
        writeLight("lamp.hdr", 2, 2, {{1, 1, 1}, {2, 2, 2}, {4, 4, 4}, {8, 8, 8}});
    const Scene projection =
        loadV4("LightSource \"projection\" \"float fov\" 60 \"string filename\" \"" + name + "\" " +
               kTriangle);
    ASSERT_EQ(projection.lights.size(), 1u);
    EXPECT_EQ(projection.lights[0].kind, LightKind::Projector);
    EXPECT_NEAR(glm::length(projection.lights[0].edgeX), 0.5 / std::tan(pi / 6), 1e-5);
    const Scene around = loadV4("LightSource \"goniometric\" \"string filename\" \"" + name +
                                "\" \"float power\" 100 " + kTriangle);
    EXPECT_EQ(around.lights.size(), 6u);
}

TEST(PbrtAreaLights, ShineOnOneSide) {
    const Material one =
        materialV4("AreaLightSource \"diffuse\" \"rgb L\" [1 2 3] \"float scale\" 2");
    expectNear(one.emission, {2, 4, 6});
    EXPECT_FALSE(one.emitsBothSides);
    EXPECT_TRUE(materialV4("AreaLightSource \"diffuse\" \"bool twosided\" true").emitsBothSides);
    // Half of a square metre, on one side.
    expectNear(materialV4("AreaLightSource \"diffuse\" \"float power\" 10").emission,
               glm::dvec3(10 / (pi * 0.5)), 1e-3);
    EXPECT_EQ(materialV4("AttributeBegin AreaLightSource \"diffuse\" AttributeEnd").emission.x, 0);
    const Scene sphere = loadV4(
        "AreaLightSource \"diffuse\" \"float power\" 10 Shape \"sphere\" \"float radius\" 2");
    ASSERT_EQ(sphere.spheres.size(), 1u);
    expectNear(sphere.materials[sphere.spheres[0].material].emission,
               glm::dvec3(10 / (pi * 16 * pi)), 1e-5);
    // What is not there shines all the same in pbrt-v3, and not in pbrt-v4.
    const Material black = materialV3("Material \"none\" AreaLightSource \"diffuse\"");
    EXPECT_EQ(black.opacity, 1);
    EXPECT_EQ(black.alphaMode, AlphaMode::Opaque);
    const std::string nothing = "Material \"interface\" AreaLightSource \"diffuse\"";
    EXPECT_EQ(materialV4(nothing).opacity, 0);
    EXPECT_EQ(materialV4(nothing).emission, glm::vec3(0));
    EXPECT_THAT(problemInV4(nothing + kTriangle),
                HasSubstr("is an area light of the material 'interface'"));
}

TEST(PbrtAreaLights, WithoutTheirPicturesShineEvenly) {
    expectNear(
        materialV4("AreaLightSource \"diffuse\" \"string filename\" \"none.png\" \"float scale\" 3")
            .emission,
        glm::dvec3(3));
}

/// In pbrt-v4 such a light is not seen, and gives all its light. Here as much of it meets surfaces.
TEST(PbrtAreaLights, ThatAreNotSeenGiveTheirLight) {
    const std::string light = "AreaLightSource \"diffuse\" \"rgb L\" [1 2 3] ";
    const std::string shape =
        "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0] \"float alpha\" 0";
    const Scene scene = loadV4(light + shape);
    const Material& m = scene.materials.at(scene.triangles.at(0).material);
    EXPECT_EQ(m.alphaMode, AlphaMode::Blend);
    EXPECT_LE(m.opacity, 0.25f);
    expectNear(double(m.opacity) * glm::dvec3(m.emission), {1, 2, 3});
    EXPECT_THAT(problemInV4(light + shape), HasSubstr("is an area light that is not seen"));
}

/// Each patch is a light of its own: two of one square metre give twice the power.
TEST(PbrtAreaLights, HavePowerByPatches) {
    const std::string light =
        "AreaLightSource \"diffuse\" \"float power\" 10 Shape \"bilinearmesh\" ";
    const auto emission = [](const Scene& scene) {
        return glm::dvec3(scene.materials.at(scene.triangles.at(0).material).emission);
    };
    const std::string one = "\"point3 P\" [0 0 0 1 0 0 0 1 0 1 1 0]",
                      two =
                          "\"point3 P\" [0 0 0 1 0 0 2 0 0 0 1 0 1 1 0 2 1 0] \"integer indices\" "
                          "[0 1 3 4 1 2 4 5] \"string emissionfilename\" \"a.png\"";
    expectNear(emission(loadV4(light + one)), glm::dvec3(10 / pi), 1e-4);
    expectNear(emission(loadV4(light + two)), glm::dvec3(10 / pi), 1e-4);
    EXPECT_EQ(problemInV4(light + two), "");

    // A PLY file's face of four corners is a patch, and one of three a triangle.
    const std::string vertices = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\n"
                                 "property float y\nproperty float z\nelement face ",
                      corners = "\nproperty list uchar int vertex_indices\nend_header\n"
                                "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
    writeFile("patch.ply", vertices + "1" + corners + "4 0 1 2 3\n");
    writeFile("triangles.ply", vertices + "2" + corners + "3 0 1 2\n3 0 2 3\n");
    const auto ofFile = [&](const std::string& file) {
        return "AreaLightSource \"diffuse\" \"float power\" 10 Shape \"plymesh\" \"string "
               "filename\" \"" +
               file + "\"";
    };
    expectNear(emission(loadV4(ofFile("patch.ply"))), glm::dvec3(10 / pi), 1e-4);
    expectNear(emission(loadV4(ofFile("triangles.ply"))), glm::dvec3(20 / pi), 1e-4);
}

/// What an environment has in a direction: the texel there (scene/model/environment.hpp).
glm::dvec3 radianceFrom(const Scene& scene, const glm::dvec3& direction) {
    const Environment& e = scene.environment.value();
    const glm::dvec3 d = glm::normalize(direction);
    double u = std::atan2(-d.x, d.z) / (2 * pi) + double(e.rotation) / (2 * pi);
    u -= std::floor(u);
    const double v = std::acos(d.y) / pi;
    const auto column = std::min(uint32_t(u * e.width), e.width - 1),
               row = std::min(uint32_t(v * e.height), e.height - 1);
    return glm::dvec3(e.radiance.at(size_t(row) * e.width + column)) * double(e.strength);
}

TEST(PbrtInfinite, IsAConstantOrASum) {
    const Scene scene =
        loadV4("LightSource \"infinite\" \"rgb L\" [1 2 3] LightSource \"infinite\" "
               "\"float illuminance\" 6.2831853 " +
               std::string(kTriangle));
    ASSERT_TRUE(scene.environment);
    EXPECT_TRUE(scene.environment->isConstant());
    expectNear(radianceFrom(scene, {0, 1, 0}), {3, 4, 5});
}

TEST(PbrtInfinite, HasAPortal) {
    const auto withPortal = [](const std::string& corners) {
        return loadV4(
            "Translate 9 9 9 LightSource \"infinite\" \"rgb L\" [1 1 1] \"point3 portal\" [" +
            corners + "] " + std::string(kTriangle));
    };
    const Scene scene = withPortal("1 2 3  1 4 3  1 4 8  1 2 8");
    ASSERT_EQ(scene.portals.size(), 1u);
    EXPECT_EQ(scene.portals[0].corner, glm::vec3(1, 2, 3)) << "in the world";
    EXPECT_EQ(scene.portals[0].edgeA, glm::vec3(0, 2, 0));
    EXPECT_EQ(scene.portals[0].edgeB, glm::vec3(0, 0, 5));
    EXPECT_THAT(scene.report.assumed, Contains(HasSubstr("its portal says where samples aim")));
    for (const char* wrong :
         {"1 2 3  1 4 3  1 4 8", "1 2 3  1 2 3  1 4 8  1 2 8", "1 2 3  1 4 3  1 6 8  1 4 8",
          "1e30 2 3  1 4 3  1 4 8  1 2 8", "1 2 3  1 4 3  9 9 9  1 2 8"}) {
        const Scene without = withPortal(wrong);
        EXPECT_TRUE(without.portals.empty()) << wrong;
        EXPECT_THAT(without.report.forgiven, Contains(HasSubstr("four corners of a rectangle")))
            << wrong;
        EXPECT_TRUE(without.environment) << wrong;
    }
}

/// The layout of pbrt-v3: columns of phi, rows from +z down.
std::string latLong() {
    std::vector<std::array<float, 3>> texels;
    for (int row = 0; row < 4; ++row)
        for (int column = 0; column < 8; ++column)
            texels.push_back({float(1 + column), float(1 + row), 1});
    return writeLight("around.hdr", 8, 4, texels);
}

/// The texel of that picture for a direction in the frame of the light.
glm::dvec3 expectedTexel(const glm::dvec3& d) {
    double phi = std::atan2(d.y, d.x);
    if (phi < 0) phi += 2 * pi;
    return {1 + std::floor(phi / (2 * pi) * 8), 1 + std::floor(std::acos(d.z) / pi * 4), 1};
}

TEST(PbrtInfinite, MapsOfAnglesStandUpright) {
    for (const char* turn : {"Rotate -90 1 0 0", "Rotate 30 0 1 0 Rotate -90 1 0 0",
                             "Scale -1 1 1 Rotate -90 1 0 0", "Rotate 90 1 0 0 Rotate 77 0 0 1"}) {
        const Scene scene = loadV3("AttributeBegin " + std::string(turn) +
                                   " LightSource \"infinite\" \"string mapname\" \"" + latLong() +
                                   "\" AttributeEnd " + kTriangle);
        ASSERT_EQ(scene.environment->width, 8u) << turn; // texels stay what they are
        // That turn as a matrix, by the place where it moves a triangle.
        for (const glm::dvec3 d : {glm::dvec3(0.9, 0.35, 0.3), glm::dvec3(-0.4, 0.8, -0.3),
                                   glm::dvec3(0.2, -0.9, 0.45), glm::dvec3(-0.6, -0.4, -0.7)}) {
            const Scene moved = loadV3(fmt::format(
                "{} Shape \"trianglemesh\" \"point P\" [0 0 0 {} {} {} 5 9 7] \"integer indices\" "
                "[0 1 2]",
                turn, d.x, d.y, d.z));
            glm::dvec3 world(0.0);
            for (const glm::vec3& p : moved.positions)
                if (std::abs(glm::length(glm::dvec3(p)) - glm::length(d)) < 1e-3) world = p;
            expectNear(radianceFrom(scene, world), expectedTexel(glm::normalize(d)));
        }
    }
}

TEST(PbrtInfinite, OtherMapsAreResampled) {
    const Scene scene =
        loadV3("LightSource \"infinite\" \"string mapname\" \"" + latLong() + "\" " + kTriangle);
    EXPECT_EQ(scene.environment->width, 16u);
    // The middle of the fourth column of the second row.
    const double theta = 67.5 * pi / 180, phi = 157.5 * pi / 180;
    expectNear(radianceFrom(scene, {std::sin(theta) * std::cos(phi),
                                    std::sin(theta) * std::sin(phi), std::cos(theta)}),
               {4, 2, 1}, 0.5);
    double sum = 0, all = 0; // of light the map has as much as before
    for (uint32_t row = 0; row < scene.environment->height; ++row)
        for (uint32_t column = 0; column < scene.environment->width; ++column) {
            const double weight = std::sin(pi * (row + 0.5) / scene.environment->height);
            sum += weight * double(scene.environment->radiance[size_t(row) * 16 + column].x);
            all += weight;
        }
    EXPECT_NEAR(sum / all, 4.5, 0.05);
}

TEST(PbrtSquareMaps, AreOfEqualAreas) {
    for (int i = 0; i < 400; ++i) {
        const glm::dvec2 p((i % 20 + 0.5) / 20, (double(i / 20) + 0.5) / 20);
        const glm::dvec3 d = pbrt::directionOfSquare(p);
        EXPECT_NEAR(glm::length(d), 1, 1e-12);
        const glm::dvec2 back = pbrt::squareOfDirection(d);
        EXPECT_NEAR(back.x, p.x, 1e-9);
        EXPECT_NEAR(back.y, p.y, 1e-9);
    }
    expectNear(pbrt::directionOfSquare({0.5, 0.5}), {0, 0, 1});
    EXPECT_NEAR(pbrt::directionOfSquare({0.001, 0.001}).z, -1, 0.01);
    const std::string name =
        writeLight("square.hdr", 2, 2, {{1, 1, 1}, {2, 2, 2}, {4, 4, 4}, {8, 8, 8}});
    const std::string light = "LightSource \"infinite\" \"string filename\" \"" + name + "\" ";
    const Scene scene = loadV4(light + kTriangle);
    EXPECT_NEAR(radianceFrom(scene, {-0.5, -0.5, 0.1}).x, 1, 1e-3);
    EXPECT_NEAR(radianceFrom(scene, {0.5, -0.5, 0.1}).x, 2, 1e-3);
    EXPECT_NEAR(radianceFrom(scene, {0.5, 0.5, -0.1}).x, 8, 1e-3);
    // pbrt counts half of the upper half of a white map.
    const std::string white =
        writeLight("white.hdr", 32, 32, std::vector<std::array<float, 3>>(1024, {1, 1, 1}));
    const Scene lit = loadV4("LightSource \"infinite\" \"float illuminance\" 10 \"string "
                             "filename\" \"" +
                             white + "\" " + kTriangle);
    EXPECT_NEAR(radianceFrom(lit, {0.5, 0.5, 0.1}).x, 10 / (pi / 2), 0.05);
}

TEST(PbrtLights, ThatCannotBeReadAreSaid) {
    EXPECT_THAT(problemInV4("LightSource \"laser\""),
                HasSubstr("'laser' is no light that is read"));
    EXPECT_THAT(problemInV4("LightSource \"infinite\" \"string filename\" \"no.exr\""),
                HasSubstr("names the file 'no.exr', which is not there"));
    EXPECT_THAT(problemInV4("LightSource \"point\" \"rgb J\" [1 1 1]"),
                HasSubstr("has 'J', which nothing reads"));
}

} // namespace
} // namespace stromboli::test
