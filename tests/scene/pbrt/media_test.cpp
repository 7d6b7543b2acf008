// Media of both versions.
#include "tests/scene/pbrt/pbrt_text.hpp"

#include <string>

namespace stromboli::test {
namespace {

using testing::Contains;
using testing::HasSubstr;

const std::string kInFog =
    "AttributeBegin MediumInterface \"fog\" \"\" Material \"interface\" Shape \"sphere\" "
    "AttributeEnd ";

std::string fog(const std::string& parameters) {
    return "MakeNamedMedium \"fog\" " + parameters + " " + kInFog;
}

void expectColors(const Medium& m, const glm::vec3& scattering, const glm::vec3& absorption) {
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(m.scattering[c], scattering[c], 1e-4) << c;
        EXPECT_NEAR(m.absorption[c], absorption[c], 1e-4) << c;
    }
}

TEST(PbrtMedia, AreHomogeneous) {
    const std::string stated = "\"string type\" \"homogeneous\" \"rgb sigma_a\" [1 2 3] "
                               "\"rgb sigma_s\" [4 5 6] \"float scale\" 0.5 \"float g\" 0.25";
    const Medium m = loadV4(fog(stated)).media.at(0);
    expectColors(m, {2, 2.5f, 3}, {0.5f, 1, 1.5f});
    EXPECT_EQ(m.asymmetry, 0.25f);
    // Whole milk.
    expectColors(loadV4(fog("\"string type\" \"homogeneous\"")).media.at(0), {2.55f, 3.21f, 3.77f},
                 {0.0011f, 0.0024f, 0.014f});
    expectColors(loadV3(fog("\"string type\" \"homogeneous\"")).media.at(0), {2.55f, 3.21f, 3.77f},
                 {0.0011f, 0.0024f, 0.014f});
}

TEST(PbrtMedia, Shine) {
    const Medium m = loadV4(fog("\"string type\" \"homogeneous\" \"rgb sigma_a\" [1 2 3] "
                                "\"rgb Le\" [1 1 2] \"float Lescale\" 3"))
                         .media.at(0);
    EXPECT_NEAR(m.emission.y / m.emission.x, 2, 1e-4);
    EXPECT_NEAR(m.emission.z / m.emission.x, 6, 1e-4);
}

TEST(PbrtMedia, AreOnBothSides) {
    const Scene scene = loadV4("MakeNamedMedium \"a\" \"string type\" \"homogeneous\" "
                               "MakeNamedMedium \"b\" \"string type\" \"homogeneous\" "
                               "MediumInterface \"a\" \"b\" Material \"dielectric\" "
                               "Shape \"sphere\"");
    const Material& m = scene.materials.at(scene.spheres.at(0).material);
    EXPECT_EQ(scene.media.at(m.inside).name, "a");
    EXPECT_EQ(scene.media.at(m.outside).name, "b");
    // A surface within one medium is no border.
    const Scene within = loadV4("MakeNamedMedium \"a\" \"string type\" \"homogeneous\" "
                                "MediumInterface \"a\" \"a\" Shape \"sphere\"");
    EXPECT_TRUE(within.media.empty());
}

TEST(PbrtMedia, AreGridsInTheirOwnCoordinates) {
    const std::string grid =
        "\"integer nx\" 2 \"integer ny\" 1 \"integer nz\" 1 \"float density\" [1 3] "
        "\"point3 p0\" [0 0 0] \"point3 p1\" [2 2 2]";
    const Scene scene =
        loadV4("AttributeBegin Translate 1 0 0 MakeNamedMedium \"fog\" \"string type\" "
               "\"uniformgrid\" " +
               grid + " AttributeEnd " + kInFog);
    const Medium& m = scene.media.at(0);
    ASSERT_TRUE(m.density);
    expectColors(m, glm::vec3(1), glm::vec3(1));
    EXPECT_EQ(m.density->place({2, 1, 1}), glm::dvec3(0.5));
    EXPECT_DOUBLE_EQ(m.density->at(glm::dvec3(0.5)), 2);
    EXPECT_DOUBLE_EQ(m.density->at(glm::dvec3(0.1, 0.5, 0.5)), 1);
    EXPECT_DOUBLE_EQ(m.density->at(glm::dvec3(1.1, 0.5, 0.5)), 0);
}

TEST(PbrtMedia, OfColouredGridsHaveTheirMeans) {
    const Scene scene = loadV4(fog("\"string type\" \"rgbgrid\" \"integer nx\" 2 "
                                   "\"integer ny\" 1 \"integer nz\" 1 "
                                   "\"rgb sigma_a\" [1 1 1 3 3 3] \"rgb sigma_s\" "
                                   "[0 0 0 2 2 2]"));
    const Medium& m = scene.media.at(0);
    ASSERT_TRUE(m.density);
    EXPECT_EQ(m.density->values, (std::vector<float>{1, 5}));
    // Means 2 and 1, over the mean extinction 3.
    expectColors(m, glm::vec3(1 / 3.0f), glm::vec3(2 / 3.0f));
}

TEST(PbrtMedia, ThatCannotBeReadAreSaid) {
    EXPECT_THAT(problemInV4(fog("\"string type\" \"plasma\"")), HasSubstr("is 'plasma'"));
    EXPECT_THAT(problemInV4(kInFog), HasSubstr("names the medium 'fog', which is not there"));
    EXPECT_THAT(problemInV4(fog("\"string type\" \"uniformgrid\" \"integer nx\" 2 "
                                "\"float density\" [1]")),
                HasSubstr("has 1 values of 'density', expected 2"));
}

} // namespace
} // namespace stromboli::test
