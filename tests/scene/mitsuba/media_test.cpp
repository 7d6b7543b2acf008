// Media of Mitsuba 3 and 0.x, and volumes.
#include "scene/mitsuba/volumes.hpp"
#include "tests/scene/mitsuba/mitsuba_text.hpp"

#include <cmath>
#include <cstring>
#include <random>

namespace stromboli::test {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;

std::string ball(const std::string& medium, const std::string& more = "") {
    return "<shape type=\"sphere\">" + medium + more + "</shape>";
}

/// The medium in a ball whose surface is nothing else.
Medium mediumOf(const std::string& type, const std::string& inside) {
    const Scene scene =
        loadInside(ball("<medium name=\"interior\" type=\"" + type + "\">" + inside + "</medium>",
                        "<bsdf type=\"null\"/>"));
    return scene.media.at(0);
}

void expectColors(const Medium& m, const glm::vec3& scattering, const glm::vec3& absorption) {
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(m.scattering[c], scattering[c], 1e-5) << c;
        EXPECT_NEAR(m.absorption[c], absorption[c], 1e-5) << c;
    }
}

TEST(MitsubaMedia, AreHomogeneous) {
    expectColors(mediumOf("homogeneous", "<rgb name=\"albedo\" value=\"0.5, 0.25, 1\"/>"
                                         "<float name=\"sigma_t\" value=\"2\"/>"
                                         "<float name=\"scale\" value=\"3\"/>"),
                 {3, 1.5f, 6}, {3, 4.5f, 0});
    expectColors(mediumOf("homogeneous", ""), glm::vec3(0.75f), glm::vec3(0.25f));
    expectColors(mediumOf("homogeneous", "<rgb name=\"sigma_s\" value=\"1, 2, 3\"/>"
                                         "<rgb name=\"sigma_a\" value=\"4, 5, 6\"/>"),
                 {1, 2, 3}, {4, 5, 6});
    expectColors(mediumOf("homogeneous", "<string name=\"material\" value=\"ketchup\"/>"
                                         "<float name=\"scale\" value=\"10\"/>"),
                 {1.8f, 0.7f, 0.3f}, {0.61f, 9.7f, 14.5f});
    expectColors(mediumOf("homogeneous",
                          "<volume name=\"albedo\" type=\"constvolume\"><float name=\"value\" "
                          "value=\"0.5\"/></volume>"),
                 glm::vec3(0.5f), glm::vec3(0.5f));
}

TEST(MitsubaMedia, HavePhaseFunctions) {
    const auto phaseOf = [](const std::string& phase) { return mediumOf("homogeneous", phase); };
    EXPECT_EQ(phaseOf("<phase type=\"hg\"><float name=\"g\" value=\"-0.5\"/></phase>").asymmetry,
              -0.5f);
    EXPECT_EQ(phaseOf("<phase type=\"isotropic\"/>").asymmetry, 0);
    EXPECT_EQ(phaseOf("<phase type=\"rayleigh\"/>").phase, PhaseFunction::Rayleigh);
}

TEST(MitsubaMedia, HaveSumsOfPhaseFunctions) {
    constexpr PhaseFunction kHg = PhaseFunction::HenyeyGreenstein;
    const std::string narrow = "<phase type=\"hg\"><float name=\"g\" value=\"0.75\"/></phase>";
    const std::string inner = "<phase type=\"blendphase\"><float name=\"weight\" value=\"0.5\"/>"
                              "<phase type=\"isotropic\"/><phase type=\"rayleigh\"/></phase>";
    const Medium blend =
        mediumOf("homogeneous", "<phase type=\"blendphase\"><float name=\"weight\" "
                                "value=\"0.25\"/>" +
                                    narrow + inner + "</phase>");
    EXPECT_THAT(blend.phases(), ElementsAre(PhaseLobe{kHg, 0.75f, 0.75f}, PhaseLobe{kHg, 0, 0.125f},
                                            PhaseLobe{PhaseFunction::Rayleigh, 0, 0.125f}));
    const std::string old =
        "<phase type=\"mixturephase\"><string name=\"weights\" value=\"WEIGHTS\"/>" + narrow +
        "<phase type=\"isotropic\"/><phase type=\"isotropic\"/></phase>";
    const auto oldText = [&](std::string weights) {
        std::string text = old;
        text.replace(text.find("WEIGHTS"), 7, weights);
        return "<shape type=\"sphere\"><medium name=\"interior\" type=\"homogeneous\">" + text +
               "</medium></shape>";
    };
    // Equal ones are one, and shares are in proportion.
    EXPECT_THAT(loadOld(oldText("2, 1, 1")).media.at(0).phases(),
                ElementsAre(PhaseLobe{kHg, 0.75f, 0.5f}, PhaseLobe{kHg, 0, 0.5f}));
    EXPECT_THAT(problemInOld(oldText("2, 1")), HasSubstr("has 2 numbers for 3 phase functions"));
}

TEST(MitsubaMedia, AreOnBothSides) {
    const Scene scene =
        loadInside("<medium type=\"homogeneous\" id=\"fog\"/>" +
                   ball("<medium name=\"interior\" type=\"homogeneous\"><float name=\"sigma_t\" "
                        "value=\"2\"/></medium><ref name=\"exterior\" id=\"fog\"/>",
                        "<bsdf type=\"dielectric\"/>") +
                   "<sensor type=\"perspective\"><ref id=\"fog\"/></sensor>");
    ASSERT_EQ(scene.media.size(), 2u);
    const Material& m = scene.materials.at(scene.spheres.at(0).material);
    EXPECT_TRUE(m.boundsMedia);
    EXPECT_NE(m.inside, m.outside);
    EXPECT_EQ(scene.cameras.at(0).medium, m.outside);
    EXPECT_EQ(scene.media.at(m.outside).name, "fog");
}

/// What nothing is in contact with is not part of the scene.
TEST(MitsubaMedia, AreLeftOutWhereNothingIsInThem) {
    const Scene scene = loadInside("<medium type=\"homogeneous\" id=\"fog\"/>" + ball(""));
    EXPECT_TRUE(scene.media.empty());
}

template <class T>
void append(std::string& bytes, const T& value) {
    const size_t at = bytes.size();
    bytes.resize(at + sizeof value);
    std::memcpy(bytes.data() + at, &value, sizeof value);
}

/// A grid of 2 x 1 x 3 values, in a box.
std::string volumeBytes(int32_t encoding, int32_t channels = 1) {
    std::string bytes = "VOL\x03";
    for (const int32_t number : {encoding, 2, 1, 3, channels})
        append(bytes, number);
    for (const float corner : {0.0f, -1.0f, 2.0f, 4.0f, 1.0f, 3.0f})
        append(bytes, corner);
    for (int i = 0; i < 6 * channels; ++i) {
        if (encoding == 1) append(bytes, float(i));
        if (encoding == 2) append(bytes, uint16_t(i == 0 ? 0 : 0x3C00)); // 1 as a half
        if (encoding == 3) append(bytes, uint8_t(51 * (i % 6)));
    }
    return bytes;
}

TEST(MitsubaVolumes, HaveThreeEncodings) {
    const mitsuba::VolumeFile floats = mitsuba::parseVolume(volumeBytes(1), "a.vol");
    EXPECT_EQ(floats.grid.size, glm::uvec3(2, 1, 3));
    EXPECT_THAT(floats.grid.values, ElementsAre(0, 1, 2, 3, 4, 5));
    EXPECT_EQ(floats.low, glm::dvec3(0, -1, 2));
    EXPECT_EQ(floats.high, glm::dvec3(4, 1, 3));
    EXPECT_DOUBLE_EQ(floats.mean.x, 2.5);
    EXPECT_THAT(mitsuba::parseVolume(volumeBytes(2), "a.vol").grid.values,
                ElementsAre(0, 1, 1, 1, 1, 1));
    EXPECT_FLOAT_EQ(mitsuba::parseVolume(volumeBytes(3), "a.vol").grid.values.at(5), 1);
    EXPECT_THAT(mitsuba::parseVolume(volumeBytes(1, 3), "a.vol").grid.values,
                ElementsAre(1, 4, 7, 10, 13, 16));
}

TEST(MitsubaVolumes, ThatAreNoneAreErrors) {
    const auto problem = [](std::string bytes) -> std::string {
        try {
            mitsuba::parseVolume(bytes, "a.vol");
        } catch (const SceneError& error) {
            return error.what();
        }
        return "";
    };
    EXPECT_THAT(problem("VOL"), HasSubstr("is no volume"));
    EXPECT_THAT(problem(volumeBytes(7)), HasSubstr("encoding 7"));
    EXPECT_THAT(problem(volumeBytes(1, 2)), HasSubstr("2 channels"));
    for (size_t cut = 0; cut < volumeBytes(1).size(); ++cut)
        EXPECT_NE(problem(volumeBytes(1).substr(0, cut)), "") << cut;
}

/// A volume or an error, whatever the bytes are, and no more values than there are bytes.
TEST(MitsubaVolumes, MayBeDamaged) {
    std::mt19937 random(1);
    int read = 0;
    for (int i = 0; i < 6000; ++i) {
        std::string bytes = volumeBytes(1 + i % 3, i % 2 == 0 ? 1 : 3);
        for (int k = 0; k < 1 + i % 3; ++k)
            bytes[random() % bytes.size()] = char(random());
        if (i % 5 == 0) bytes.resize(random() % bytes.size());
        try {
            const mitsuba::VolumeFile file = mitsuba::parseVolume(bytes, "a.vol");
            ++read;
            ASSERT_LE(file.grid.values.size(), bytes.size());
            for (const float value : file.grid.values)
                ASSERT_TRUE(std::isfinite(value) && value >= 0);
        } catch (const SceneError&) {
        }
    }
    EXPECT_GT(read, 1000);
}

TEST(MitsubaMedia, HaveGrids) {
    const std::string name = writeFile("smoke.vol", volumeBytes(1)).filename().string();
    const std::string volume =
        "type=\"gridvolume\"><string name=\"filename\" value=\"" + name + "\"/>";
    const Medium m = mediumOf("heterogeneous", "<volume name=\"sigma_t\" " + volume +
                                                   "<transform name=\"to_world\"><scale x=\"4\"/>"
                                                   "</transform></volume><float name=\"albedo\" "
                                                   "value=\"0.5\"/>");
    ASSERT_TRUE(m.density);
    expectColors(m, glm::vec3(0.5f), glm::vec3(0.5f));
    EXPECT_EQ(m.density->place({2, 0.5, 0.5}), glm::dvec3(0.5));
    const Scene blocks = loadInside(
        ball("<medium name=\"interior\" type=\"heterogeneous\"><volume name=\"sigma_t\" " + volume +
                 "<string name=\"filter_type\" value=\"nearest\"/></volume></medium>",
             "<bsdf type=\"null\"/>"));
    EXPECT_THAT(blocks.report.forgiven,
                Contains(HasSubstr("'filter_type' is 'nearest', expected trilinear")));
    // Mitsuba 0.x: the file's box, at whose sides the outermost values are.
    const Scene old = loadOld("<shape type=\"sphere\"><medium name=\"interior\" "
                              "type=\"heterogeneous\"><volume name=\"density\" " +
                              volume + "</volume></medium></shape>");
    ASSERT_TRUE(old.media.at(0).density);
    EXPECT_EQ(old.media.at(0).density->place({2, 0, 2.5}), glm::dvec3(0.5));
    const glm::dvec3 corner = old.media.at(0).density->place({0, -1, 2});
    EXPECT_NEAR(corner.x, 0.5 / 2, 1e-12);
    EXPECT_NEAR(corner.y, 0, 1e-12); // of one cell
    EXPECT_NEAR(corner.z, 0.5 / 3, 1e-12);
}

TEST(MitsubaMedia, HaveGridsOfColours) {
    const std::string colors = writeFile("colors.vol", volumeBytes(1, 3)).filename().string();
    const std::string numbers = writeFile("numbers.vol", volumeBytes(3)).filename().string();
    const auto volume = [](const std::string& name, const std::string& file) {
        return "<volume name=\"" + name +
               "\" type=\"gridvolume\"><string name=\"filename\" value=\"" + file + "\"/></volume>";
    };
    const Medium m =
        mediumOf("heterogeneous", volume("sigma_t", colors) + volume("albedo", numbers) +
                                      "<float name=\"scale\" value=\"2\"/>");
    EXPECT_FALSE(m.density);
    ASSERT_TRUE(m.colors.extinction);
    EXPECT_EQ(m.colors.extinction->values.at(1), glm::vec3(3, 4, 5));
    ASSERT_TRUE(m.colors.scattering);
    EXPECT_FALSE(m.colors.scatteringIsFactor);
    EXPECT_EQ(m.colors.scattering->values.at(5), glm::vec3(1));
    EXPECT_EQ(m.extinction(), glm::vec3(2));
    // An albedo is at most 1; one by itself has its mean where the extinction does not vary.
    const Medium tinted =
        mediumOf("heterogeneous", volume("sigma_t", numbers) + volume("albedo", colors));
    EXPECT_TRUE(tinted.density);
    EXPECT_EQ(tinted.colors.scattering->values.at(0), glm::vec3(0, 1, 1));
    const Medium plain = mediumOf("homogeneous", volume("albedo", numbers));
    EXPECT_FALSE(plain.varies());
    expectColors(plain, glm::vec3(0.5f), glm::vec3(0.5f));
}

/// A subsurface is a medium under an interface, which has the roughness of the surface.
TEST(MitsubaMedia, LieUnderSurfaces) {
    const auto under = [](const std::string& subsurface, const std::string& bsdf) {
        return loadOld(ball(subsurface, bsdf));
    };
    const Scene scene =
        under("<subsurface type=\"dipole\"><string name=\"material\" value=\"skin2\"/>"
              "<float name=\"scale\" value=\"10\"/><float name=\"g\" value=\"0.5\"/>"
              "<float name=\"intIOR\" value=\"1.4\"/><float name=\"extIOR\" "
              "value=\"1\"/><integer name=\"irrSamples\" value=\"64\"/></subsurface>",
              "<bsdf type=\"roughplastic\"><float name=\"alpha\" value=\"0.2\"/></bsdf>");
    const Material& m = scene.materials.at(scene.spheres.at(0).material);
    EXPECT_EQ(m.kind, MaterialKind::Dielectric);
    EXPECT_EQ(m.ior, 1.4f);
    EXPECT_EQ(m.facets.alpha.x, 0.2f);
    EXPECT_TRUE(m.boundsMedia);
    EXPECT_EQ(m.outside, kNoMedium);
    const Medium& medium = scene.media.at(m.inside);
    EXPECT_TRUE(medium.isUnderSurface);
    EXPECT_EQ(medium.asymmetry, 0.5f);
    expectColors(medium, {10.9f, 15.9f, 17.9f}, {0.13f, 0.7f, 1.45f});
    const Scene colored =
        under("<subsurface type=\"singlescatter\"><rgb name=\"sigmaS\" value=\"1 2 "
              "3\"/><rgb name=\"sigmaA\" value=\"4 5 6\"/></subsurface>",
              "");
    expectColors(colored.media.at(0), {1, 2, 3}, {4, 5, 6});
}

} // namespace
} // namespace stromboli::test
