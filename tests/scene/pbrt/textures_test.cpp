// Textures: pictures as they are, patterns as pictures, functions of space as their means.

#include "scene/model/surface_lookup.hpp"
#include "scene/pbrt/pattern.hpp"
#include "tests/scene/pbrt/pbrt_text.hpp"

#include <fmt/format.h>

#include <cmath>

namespace stromboli::test {
namespace {

using testing::HasSubstr;

const char* const kQuad = "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 1 1 0 0 1 0] \"point2 "
                          "uv\" [0 0 1 0 1 1 0 1] \"integer indices\" [0 1 2 0 2 3]\n";

/// What a texture makes of a diffuse surface at some coordinates.
struct Shown {
    explicit Shown(const std::string& texture)
        : scene(loadV4(texture + " Material \"diffuse\" \"texture reflectance\" \"t\" " + kQuad)) {}

    glm::dvec3 at(double u, double v) const {
        const Material& m = scene.materials.at(scene.triangles.at(0).material);
        glm::dvec3 color(m.albedo);
        PointAttributes point;
        point.uv[0] = {u, v};
        for (const TextureUse& use : m.textures)
            color *= glm::dvec3(lookUp(scene, use, point));
        return color;
    }

    Scene scene;
};

void expectColor(const glm::dvec3& a, const glm::dvec3& b, double tolerance = 2e-3) {
    for (const int c : {0, 1, 2})
        EXPECT_NEAR(a[c], b[c], tolerance) << c;
}

std::string imageMap(const std::string& more = "") {
    // The upper row red and green, the lower one blue and white.
    const std::string name =
        writePicture("four.tga", 2, 2, {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {255, 255, 255}});
    return "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"" + name + "\" " + more;
}

TEST(PbrtTextures, PicturesHaveTheirFirstRowAtTheTop) {
    const Shown shown(imageMap());
    expectColor(shown.at(0.25, 0.75), {1, 0, 0});
    expectColor(shown.at(0.75, 0.75), {0, 1, 0});
    expectColor(shown.at(0.25, 0.25), {0, 0, 1});
}

TEST(PbrtTextures, PicturesAreScaledMovedAndInverted) {
    const Shown moved(imageMap("\"float uscale\" 2 \"float udelta\" .5"));
    expectColor(moved.at(0.125, 0.75), {0, 1, 0}); // s = 0.75
    const Shown scaled(imageMap("\"float scale\" .5"));
    expectColor(scaled.at(0.25, 0.75), {0.5, 0, 0});
    const Shown inverted(imageMap("\"bool invert\" true"));
    expectColor(inverted.at(0.25, 0.75), {0, 1, 1});
}

TEST(PbrtTextures, PicturesHaveAnEncoding) {
    const std::string name = writePicture("grey.tga", 1, 1, {{128, 128, 128}});
    const auto grey = [&](const std::string& more) {
        return Shown("Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"" + name +
                     "\" " + more)
            .at(0.5, 0.5)
            .x;
    };
    EXPECT_NEAR(grey(""), 0.2159, 1e-3);
    EXPECT_NEAR(grey("\"string encoding\" \"linear\""), 0.502, 1e-3);
    EXPECT_NEAR(grey("\"string encoding\" \"gamma 2\""), 0.252, 1e-3);
}

TEST(PbrtTextures, ScalesAndMixes) {
    expectColor(Shown(imageMap() +
                      " Texture \"u\" \"spectrum\" \"constant\" \"rgb value\" [.5 1 1] "
                      "Texture \"t\" \"spectrum\" \"scale\" \"texture tex\" \"t\" "
                      "\"texture scale\" \"u\"")
                    .at(0.25, 0.75),
                {0.5, 0, 0});
    expectColor(Shown(imageMap() + " Texture \"t\" \"spectrum\" \"mix\" \"texture tex1\" \"t\" "
                                   "\"rgb tex2\" [0 0 1] \"float amount\" .25")
                    .at(0.25, 0.75),
                {0.75, 0, 0.25});
}

TEST(PbrtTextures, Checkerboards) {
    const Shown shown("Texture \"t\" \"spectrum\" \"checkerboard\" \"float uscale\" 4 \"float "
                      "vscale\" 4 \"rgb tex1\" [1 0 0] \"rgb tex2\" [0 1 0]");
    expectColor(shown.at(0.1, 0.1), {1, 0, 0});
    expectColor(shown.at(0.3, 0.1), {0, 1, 0});
    expectColor(shown.at(0.3, 0.3), {1, 0, 0});
    expectColor(shown.at(0.249, 0.01), {1, 0, 0});
    expectColor(shown.at(0.6, 0.9), {0, 1, 0});
}

/// What lies in the squares has its own coordinates.
TEST(PbrtTextures, CheckerboardsOfPictures) {
    const std::string squares =
        "Texture \"t\" \"spectrum\" \"checkerboard\" \"float uscale\" 3 \"float vscale\" 3 "
        "\"texture tex1\" \"t\" \"rgb tex2\" [.5 .5 .5] ";
    const Shown shown(imageMap() + " " + squares);
    expectColor(shown.at(0.25, 0.25), {0, 0, 1}, 0.02);
    expectColor(shown.at(0.5, 0.1), {0.5, 0.5, 0.5});
    expectColor(shown.at(0.75, 0.25), {1, 1, 1}, 0.02);
    expectColor(shown.at(0.75, 0.75), {0, 1, 0}, 0.02);
    // They go on beyond 1, where the picture begins again and the squares do not.
    expectColor(shown.at(1.25, 0.25), {0.5, 0.5, 0.5});
    expectColor(shown.at(2.25, 0.25), {0, 0, 1}, 0.02);
}

TEST(PbrtTextures, OtherPatternsBecomePictures) {
    expectColor(Shown("Texture \"t\" \"spectrum\" \"uv\"").at(0.3, 0.6), {0.3, 0.6, 0}, 4e-3);
    const Shown corners("Texture \"t\" \"spectrum\" \"bilerp\" \"rgb v00\" [0 0 0] \"rgb v10\" [1 "
                        "0 0] \"rgb v01\" [0 1 0] \"rgb v11\" [1 1 0]");
    expectColor(corners.at(0.25, 0.75), {0.25, 0.75, 0}, 0.01);
    const Shown dots("Texture \"t\" \"spectrum\" \"dots\" \"float uscale\" 16 \"float vscale\" 16");
    double mean = 0;
    for (int i = 0; i < 4096; ++i)
        mean += dots.at((i % 64 + 0.5) / 64, (double(i / 64) + 0.5) / 64).x / 4096;
    EXPECT_GT(mean, 0.08); // half of the cells have a disk of 38 % of them
    EXPECT_LT(mean, 0.35);
}

TEST(PbrtTextures, FunctionsOfSpaceAreTheirMeans) {
    const std::string marble = "Texture \"t\" \"spectrum\" \"marble\" Material \"diffuse\" "
                               "\"texture reflectance\" \"t\" ";
    EXPECT_THAT(problemInV4(marble + kQuad),
                HasSubstr("<Texture \"marble\">: is a function of the place in space"));
    EXPECT_GT(materialV4(marble).albedo.x, 0.5f);
    EXPECT_THAT(problemInV4("Texture \"t\" \"spectrum\" \"ptex\""),
                HasSubstr("has a picture for each face"));
    EXPECT_THAT(problemInV4("Texture \"t\" \"spectrum\" \"clouds\""),
                HasSubstr("'clouds' is no texture that is read"));
}

TEST(PbrtTextures, MappingsBySpaceAreThoseOfCorners) {
    const Scene scene =
        loadV4(imageMap("\"string mapping\" \"planar\" \"vector3 v1\" [.5 0 0] \"vector3 v2\" [0 "
                        ".25 0] \"float udelta\" .125") +
               " Material \"diffuse\" \"texture reflectance\" \"t\" " + kQuad);
    const Material& m = scene.materials.at(scene.triangles.at(0).material);
    ASSERT_EQ(m.textures.size(), 1u);
    EXPECT_EQ(m.textures[0].uvSet, 1u);
    const uint32_t corner = scene.attributeCorners[0][2]; // (1, 1, 0)
    EXPECT_EQ(scene.attributes[corner].uv[1], glm::vec2(0.625f, 0.25f));
}

/// In pbrt-v4 a plane lies in the coordinates of its texture, and in pbrt-v3 in the world; there
/// the height of a cylinder is that of the direction.
TEST(PbrtTextures, MappingsBySpaceAreMovedWithTheTexture) {
    const auto corner = [](const Scene& scene) {
        const uint32_t third = scene.attributeCorners[0][2]; // (1, 1, 0)
        return glm::dvec2(scene.attributes[third].uv[1]);
    };
    const auto text = [](const std::string& mapping, const std::string& kind, const char* name) {
        return "AttributeBegin Translate 0.5 0 -2 Scale 2 1 4 " +
               imageMap("\"string mapping\" \"" + mapping + "\"") + " Material \"" + kind +
               "\" \"texture " + name + "\" \"t\" Identity " + kQuad + " AttributeEnd";
    };
    const auto v4 = [&](const std::string& mapping) {
        return corner(loadV4(text(mapping, "diffuse", "reflectance")));
    };
    const auto v3 = [&](const std::string& mapping) {
        return corner(loadV3(text(mapping, "matte", "Kd")));
    };
    // The corner is (0.25, 1, 0.5) there.
    EXPECT_NEAR(glm::distance(v4("planar"), glm::dvec2(0.25, 1)), 0, 1e-6);
    EXPECT_NEAR(glm::distance(v3("planar"), glm::dvec2(1, 1)), 0, 1e-6);
    EXPECT_NEAR(v4("cylindrical").y, 0.5, 1e-6);
    EXPECT_NEAR(v3("cylindrical").y, 0.5 / std::sqrt(0.0625 + 1 + 0.25), 1e-6);
}

TEST(PbrtTextures, PicturesOfFloatsHaveNoEncoding) {
    const std::string name = writeLight("half.hdr", 1, 1, {{0.5f, 0.5f, 0.5f}});
    const Scene scene = loadV4(
        "Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"" + name +
        "\" \"string encoding\" \"gamma 2\" Material \"diffuse\" \"texture reflectance\" \"t\" " +
        kQuad);
    const Material& m = scene.materials.at(scene.triangles.at(0).material);
    EXPECT_NEAR(lookUp(scene, m.textures.at(0), {}).x * m.albedo.x, 0.5, 1e-3);
}

TEST(PbrtTextures, ThatAreNotThereAreSaid) {
    EXPECT_THAT(
        problemInV4("Material \"diffuse\" \"texture reflectance\" \"t\" " + std::string(kTriangle)),
        HasSubstr("names the texture 't', which is not there"));
    EXPECT_THAT(
        problemInV4("Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"a.png\""),
        HasSubstr("names the file 'a.png', which is not there"));
}

TEST(PbrtTextures, RoughnessBecomesAlpha) {
    const std::string name = writePicture("quarter.tga", 1, 1, {{64, 64, 64}});
    const Scene scene =
        loadV4("Texture \"r\" \"float\" \"imagemap\" \"string filename\" \"" + name +
               "\" \"string encoding\" \"linear\" Material \"conductor\" \"texture roughness\" "
               "\"r\" " +
               kQuad);
    const Material& m = scene.materials.at(scene.triangles.at(0).material);
    EXPECT_THAT(scene.report.forgiven, testing::IsEmpty());
    ASSERT_EQ(m.textures.size(), 1u);
    EXPECT_EQ(m.textures[0].slot, TextureSlot::MetallicRoughness);
    const glm::dvec4 texel = lookUp(scene, m.textures[0], {});
    EXPECT_NEAR(texel.y, 0.501, 1e-3);
    EXPECT_NEAR(texel.z, 0.501, 1e-3);
}

TEST(PbrtTextures, ReliefAndAlpha) {
    const std::string name =
        writePicture("four.tga", 2, 2, {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {255, 255, 255}});
    const Scene scene = loadV4(
        "Texture \"h\" \"float\" \"imagemap\" \"string filename\" \"" + name +
        "\" \"float scale\" .25 Material \"diffuse\" \"texture displacement\" \"h\" \"string "
        "normalmap\" \"" +
        name +
        "\" Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 1 1 0] \"point2 uv\" [0 0 1 0 1 "
        "1] \"integer indices\" [0 1 2] \"texture alpha\" \"h\"");
    const Material& m = scene.materials.at(scene.triangles.at(0).material);
    ASSERT_EQ(m.textures.size(), 3u);
    EXPECT_EQ(m.textures[0].slot, TextureSlot::Height);
    EXPECT_FLOAT_EQ(m.textures[0].scale, 0.25f);
    EXPECT_EQ(m.textures[1].slot, TextureSlot::Normal);
    EXPECT_EQ(m.textures[2].slot, TextureSlot::Opacity);
    EXPECT_NE(scene.attributes.at(0).tangent.w, 0);
}

TEST(PbrtNoise, IsZeroAtWholeNumbers) {
    EXPECT_EQ(pbrt::noise({1, 2, 3}), 0);
    double sum = 0, most = 0;
    for (int i = 0; i < 1000; ++i) {
        const double value = pbrt::noise({0.13 * i, 0.71 * i, 0.37 * i});
        sum += value / 1000;
        most = std::max(most, std::abs(value));
    }
    EXPECT_NEAR(sum, 0, 0.05);
    EXPECT_LT(most, 1.01);
    EXPECT_GT(most, 0.5);
}

} // namespace
} // namespace stromboli::test
