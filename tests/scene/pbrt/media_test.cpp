// Media of both versions.
#include "scene/pbrt/colors.hpp"
#include "scene/pbrt/medium_grids.hpp"
#include "tests/scene/pbrt/pbrt_text.hpp"

#include <fmt/format.h>

#include <cmath>
#include <string>
#include <tuple>

namespace stromboli::test {
namespace {

using testing::Contains;
using testing::HasSubstr;

/// The integral of the CIE's curve of luminance over nanometres.
constexpr double kCurve = 106.856895;

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
    // pbrt-v4 has 1, and pbrt-v3 whole milk.
    expectColors(loadV4(fog("\"string type\" \"homogeneous\"")).media.at(0), glm::vec3(1),
                 glm::vec3(1));
    expectColors(loadV4(fog("\"string type\" \"homogeneous\" \"rgb sigma_s\" [2 3 4]")).media.at(0),
                 {2, 3, 4}, glm::vec3(1));
    expectColors(loadV3(fog("\"string type\" \"homogeneous\"") + "WorldEnd").media.at(0),
                 {2.55f, 3.21f, 3.77f}, {0.0011f, 0.0024f, 0.014f});
}

TEST(PbrtMedia, Shine) {
    const Medium m = loadV4(fog("\"string type\" \"homogeneous\" \"rgb sigma_a\" [1 2 3] "
                                "\"rgb Le\" [1 1 2] \"float Lescale\" 3"))
                         .media.at(0);
    EXPECT_NEAR(m.emission.y / m.emission.x, 2, 1e-4);
    EXPECT_NEAR(m.emission.z / m.emission.x, 6, 1e-4);
}

/// All light of a scene is as bright as the film's exposure says, even of media before the film's.
TEST(PbrtMedia, ShineAsTheFilmIsExposed) {
    const std::string flat =
        "\"string type\" \"homogeneous\" \"rgb sigma_a\" [1 1 1] \"rgb Le\" [2 2 2]";
    const Scene scene = loadText("MakeNamedMedium \"fog\" " + flat +
                                 " Film \"rgb\" \"float iso\" 50 WorldBegin " + kInFog);
    EXPECT_FLOAT_EQ(scene.media.at(0).emission.x, 1);
    const std::string hot = "MakeNamedMedium \"fog\" \"string type\" \"uniformgrid\" \"float "
                            "density\" [1] \"float temperature\" [3000] ";
    const Medium full = loadText("Film \"rgb\" WorldBegin " + hot + kInFog).media.at(0),
                 half = loadText("Film \"rgb\" \"float iso\" 50 WorldBegin " + hot + kInFog)
                            .media.at(0);
    EXPECT_EQ(half.colors.source->values.at(0),
              full.colors.source->values.at(0) * glm::vec3(0.5f, 1, 1));
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

const std::string kTwoCells = "\"integer nx\" 2 \"integer ny\" 1 \"integer nz\" 1 ";

void expectPoint(const MediumPoint& p, const glm::dvec3& extinction, const glm::dvec3& scattering,
                 const glm::dvec3& emission) {
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(p.extinction[c], extinction[c], 1e-5 * extinction[c]) << c;
        EXPECT_NEAR(p.scattering[c], scattering[c], 1e-5 * scattering[c]) << c;
        EXPECT_NEAR(p.emission[c], emission[c], 1e-5 * emission[c]) << c;
    }
}

TEST(PbrtMedia, AreGridsOfColours) {
    const Medium m =
        loadV4(fog("\"string type\" \"rgbgrid\" " + kTwoCells +
                   "\"rgb sigma_a\" [1 2 3 3 3 3] \"rgb sigma_s\" [0 0 4 2 2 2] \"float scale\" 2 "
                   "\"rgb Le\" [1 1 1 0 0 4] \"float Lescale\" 3"))
            .media.at(0);
    const glm::dvec3 left(0.25, 0.5, 0.5), right(0.75, 0.5, 0.5);
    // Le is not divided by the integral of the CIE's curve of luminance, as that of lamps is.
    expectPoint(m.at(left, left), {2, 4, 14}, {0, 0, 8}, kCurve * glm::dvec3(6, 12, 18));
    expectPoint(m.at(right, right), {10, 10, 10}, {4, 4, 4}, kCurve * glm::dvec3(0, 0, 72));
    EXPECT_TRUE(m.scatters());
    EXPECT_TRUE(m.emits());
    // One that is not stated is 1.
    const Medium half =
        loadV4(fog("\"string type\" \"rgbgrid\" " + kTwoCells + "\"rgb sigma_s\" [1 2 3 0 0 0]"))
            .media.at(0);
    expectPoint(half.at(left, left), {2, 3, 4}, {1, 2, 3}, {0, 0, 0});
    EXPECT_THAT(problemInV4(fog("\"string type\" \"rgbgrid\" " + kTwoCells)),
                HasSubstr("has no 'sigma_a' and no 'sigma_s'"));
    EXPECT_THAT(
        problemInV4(fog("\"string type\" \"rgbgrid\" " + kTwoCells + "\"rgb sigma_s\" [1 2 3]")),
        HasSubstr("has 3 values of 'sigma_s', expected 6"));
}

/// Planck's law, summed up here: what light of 1 at all wavelengths looks like has luminance 1.
TEST(PbrtMedia, GlowByTheirTemperature) {
    const Medium m =
        loadV4(fog("\"string type\" \"uniformgrid\" " + kTwoCells +
                   "\"float density\" [1 2] \"rgb sigma_a\" [1 1 1] \"rgb sigma_s\" [0 0 0] "
                   "\"float temperature\" [1100 2100] \"float temperatureoffset\" 100 "
                   "\"float temperaturescale\" 2 \"float Lescale\" [1 0.5]"))
            .media.at(0);
    ASSERT_TRUE(m.colors.glow);
    const glm::dvec3 left(0.25, 0.5, 0.5), right(0.75, 0.5, 0.5), middle(0.5);
    const auto light = [](double kelvins) { return glm::max(pbrt::blackbodyOfPeak(kelvins), 0.0); };
    // Between the cells temperatures are interpolated, not light.
    const std::tuple<glm::dvec3, double, double> places[] = {
        {left, 2000, 1}, {right, 4000, 2 * 0.5}, {middle, 3000, 1.5 * 0.75}};
    for (const auto& [place, kelvins, factor] : places)
        for (int c = 0; c < 3; ++c) {
            const double expected = kCurve * factor * light(kelvins)[c];
            EXPECT_NEAR(m.at(place, place).emission[c], expected, 1e-3 * kCurve * light(kelvins).x)
                << kelvins;
        }
    // Luminance of 2 h c^2 / l^5 / (exp(hc / lkT) - 1) over its peak, by the eye's curve as a
    // Gaussian about 556 nm, which is good to some percent.
    double sum = 0, all = 0;
    const auto planck = [](double nm, double kelvins) {
        return std::pow(nm, -5) / std::expm1(1.438777e7 / (nm * kelvins));
    };
    for (double nm = 380; nm <= 780; nm += 1) {
        const double eye = std::exp(-0.5 * std::pow((nm - 556) / 43, 2));
        sum += eye * planck(nm, 3000) / planck(2.8977721e6 / 3000, 3000);
        all += eye;
    }
    EXPECT_NEAR(pbrt::luminance(light(3000)) / (sum / all), 1, 0.05);
}

/// A table of black bodies is what it is a table of.
TEST(PbrtMedia, GlowByATable) {
    const GlowTable table = pbrt::glowTable(6000);
    for (double kelvins = 510; kelvins < 6000; kelvins *= 1.013) {
        const glm::dvec3 exact = glm::max(pbrt::blackbodyOfPeak(kelvins), 0.0);
        const double most = std::max({exact.x, exact.y, exact.z});
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(table.at(kelvins)[c], exact[c], 2e-3 * most) << kelvins;
    }
    EXPECT_EQ(table.at(400), glm::dvec3(0));
    EXPECT_EQ(table.at(0), glm::dvec3(0));
}

TEST(PbrtMedia, ShineInGridsByFactors) {
    const Medium m = loadV4(fog("\"string type\" \"uniformgrid\" " + kTwoCells +
                                "\"float density\" [1 2] \"rgb sigma_a\" [1 2 1] \"rgb sigma_s\" "
                                "[0 0 0] \"rgb Le\" [1 1 4] \"float Lescale\" [2 3]"))
                         .media.at(0);
    const glm::dvec3 left(0.25, 0.5, 0.5), right(0.75, 0.5, 0.5);
    expectPoint(m.at(left, left), {1, 2, 1}, {0, 0, 0}, {2, 4, 8});
    expectPoint(m.at(right, right), {2, 4, 2}, {0, 0, 0}, {6, 12, 24});
}

/// Below one half of the height a cloud is dense, and above it is thinner; there is nothing
/// above 1.
TEST(PbrtMedia, AreClouds) {
    const auto cloud = [](const std::string& more) {
        return loadV4(fog("\"string type\" \"cloud\" " + more)).media.at(0);
    };
    const Medium m = cloud("\"rgb sigma_a\" [0 0 0] \"rgb sigma_s\" [4 4 4] \"float g\" 0.5");
    expectColors(m, glm::vec3(4), glm::vec3(0));
    EXPECT_EQ(m.asymmetry, 0.5f);
    ASSERT_TRUE(m.density);
    const auto mean = [&](const Medium& medium, double y) {
        double sum = 0;
        for (int i = 0; i < 64 * 64; ++i)
            sum += medium.density->at({(i % 64 + 0.5) / 64, y, (double(i / 64) + 0.5) / 64}) / 4096;
        return sum;
    };
    EXPECT_NEAR(mean(m, 0.0), 1, 0.02);
    const double low = mean(m, 0.4), middle = mean(m, 0.6), high = mean(m, 0.95);
    EXPECT_GT(low, 0.2); // which is there without any noise
    EXPECT_GT(low, middle);
    EXPECT_GT(middle, high);
    EXPECT_LT(high, 0.1);
    // Without noise there is nothing above one half.
    const Medium plain = cloud("\"float density\" 0");
    EXPECT_NEAR(mean(plain, 0.25), 0.5, 0.01);
    EXPECT_EQ(mean(plain, 0.6), 0);
    const Medium tall = cloud("\"float density\" 0 \"point3 p0\" [0 0 0] \"point3 p1\" [1 2 1]");
    EXPECT_EQ(tall.density->size, glm::uvec3(48, 96, 48));
    EXPECT_NEAR(mean(tall, 0.125), 0.5, 0.01);
}

TEST(PbrtMedia, ThatCannotBeReadAreSaid) {
    EXPECT_THAT(problemInV4(fog("\"string type\" \"plasma\"")), HasSubstr("is 'plasma'"));
    for (const char* corner : {"0 1 1", "nan 1 1", "1 inf 1"})
        EXPECT_THAT(
            problemInV4(fog(fmt::format("\"string type\" \"cloud\" \"point3 p1\" [{}]", corner))),
            HasSubstr("has a box without a volume"));
    EXPECT_EQ(problemInV4(fog(
                  "\"string type\" \"cloud\" \"point3 p0\" [1e20 0 0] \"float frequency\" 1e6")),
              "");
    EXPECT_THAT(problemInV4(kInFog), HasSubstr("names the medium 'fog', which is not there"));
    EXPECT_THAT(problemInV4(fog("\"string type\" \"uniformgrid\" \"integer nx\" 2 "
                                "\"float density\" [1]")),
                HasSubstr("has 1 values of 'density', expected 2"));
}

/// All that is extinguished, as scattering.
Medium mediumOfSum(const Medium& m) {
    Medium sum;
    sum.scattering = m.extinction();
    return sum;
}

TEST(PbrtMedia, HaveNames) {
    const std::string kind = "\"string type\" \"homogeneous\" ";
    expectColors(loadV4(fog(kind + "\"string preset\" \"Skin1\" \"float scale\" 2")).media.at(0),
                 {1.48f, 1.76f, 2.02f}, {0.064f, 0.34f, 0.96f});
    const std::string unknown = fog(kind + "\"string preset\" \"Lava\"");
    EXPECT_THAT(problemInV4(unknown), HasSubstr("is 'Lava', which is not known"));
    expectColors(loadV4(unknown).media.at(0), {2.55f, 3.21f, 3.77f}, {0.0011f, 0.0024f, 0.014f});
}

/// Light scatters in a medium under an interface, whose scatterings do not count as bounces.
TEST(PbrtMedia, LieUnderSurfaces) {
    const auto under = [](const Scene& scene) {
        const Material& m = scene.materials.at(scene.spheres.at(0).material);
        EXPECT_EQ(m.kind, MaterialKind::Dielectric);
        EXPECT_TRUE(m.boundsMedia);
        EXPECT_EQ(m.outside, kNoMedium);
        EXPECT_TRUE(scene.media.at(m.inside).isUnderSurface);
        return scene.media.at(m.inside);
    };
    const auto v4 = [&](const std::string& parameters) {
        return under(loadV4("Material \"subsurface\" " + parameters + " Shape \"sphere\""));
    };
    const auto v3 = [&](const std::string& kind, const std::string& parameters) {
        return under(loadV3("Material \"" + kind + "\" " + parameters +
                            " Shape \"sphere\" \"float radius\" 1"));
    };
    const glm::vec3 milkScatters(2.55f, 3.21f, 3.77f), milkAbsorbs(0.0011f, 0.0024f, 0.014f);
    expectColors(v4(""), milkScatters, milkAbsorbs);
    expectColors(v3("subsurface", ""), milkScatters, milkAbsorbs);
    const Medium stated = v4("\"rgb sigma_a\" [1 2 3] \"rgb sigma_s\" [4 5 6] \"float scale\" .5 "
                             "\"float g\" .25");
    expectColors(stated, {2, 2.5f, 3}, {0.5f, 1, 1.5f});
    EXPECT_EQ(stated.asymmetry, 0.25f);
    expectColors(v4("\"string name\" \"Ketchup\" \"float scale\" 10 \"float g\" .25"),
                 {1.8f, 0.7f, 0.3f}, {0.61f, 9.7f, 14.5f});
    // A colour and the mean free path, whose product with the extinction is 1.
    for (const Medium& m :
         {v4("\"rgb reflectance\" [.2 .5 .9] \"rgb mfp\" [.5 .25 .125] \"float scale\" 2"),
          v3("kdsubsurface",
             "\"rgb Kd\" [.2 .5 .9] \"rgb mfp\" [.5 .25 .125] \"float scale\" 2")}) {
        expectColors(mediumOfSum(m), {1, 2, 4}, glm::vec3(0));
        EXPECT_LT(m.scattering.x, 0.85f);
        EXPECT_GT(m.scattering.z / 4, 0.99f);
    }
    EXPECT_THAT(
        problemInV4("Material \"subsurface\" \"string name\" \"Lava\"" + std::string(kTriangle)),
        HasSubstr("is 'Lava', which is not known"));
}

/// What varies over a surface stays a colour of it.
TEST(PbrtMedia, AreNotUnderTextures) {
    const std::string texture =
        "Texture \"t\" \"spectrum\" \"checkerboard\" Material \"subsurface\" \"texture "
        "reflectance\" \"t\" ";
    EXPECT_THAT(problemInV4(texture + kTriangle), HasSubstr("under the surface by a texture"));
}

} // namespace
} // namespace stromboli::test
