// Pictures, relief and grids of Mitsuba 0.x where it shows them otherwise than Mitsuba 3.

#include "scene/model/srgb.hpp"
#include "scene/model/surface_lookup.hpp"
#include "tests/scene/mitsuba/mitsuba_text.hpp"

#include <fmt/format.h>

#include <cmath>

namespace stromboli::test {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

/// One texel of the channels 200, 100 and 0.
std::string picture(const std::string& name, const std::string& inside = "") {
    return "<texture type=\"bitmap\" name=\"" + name + "\"><string name=\"filename\" value=\"" +
           writePicture("one.tga", 1, 1, {{200, 100, 0, 255}}) + "\"/>" + inside + "</texture>";
}

glm::dvec4 shown(const Scene& scene, const Material& material) {
    return lookUp(scene, material.textures.at(0), {{glm::dvec2(0.5), glm::dvec2(0)}});
}

std::string number(const char* name, double value) {
    return fmt::format("<float name=\"{}\" value=\"{}\"/>", name, value);
}

TEST(MitsubaOldPictures, AreDecodedByTheirPower) {
    for (const double gamma : {1.8, 2.2}) {
        const Scene scene =
            loadOld(rectangleOf("<bsdf type=\"diffuse\">" +
                                picture("reflectance", number("gamma", gamma)) + "</bsdf>"));
        EXPECT_THAT(scene.report.forgiven, IsEmpty());
        const glm::dvec4 texel = shown(scene, scene.materials.at(0));
        EXPECT_NEAR(texel.x, std::pow(200 / 255.0, gamma), 1e-3);
        EXPECT_NEAR(texel.y, std::pow(100 / 255.0, gamma), 1e-3);
    }
}

/// Mitsuba 3 takes the luminance.
TEST(MitsubaOldPictures, AreNumbersByTheMeanOfTheirChannels) {
    const double mean = (srgbToLinear(200 / 255.0) + srgbToLinear(100 / 255.0)) / 3;
    const std::string blend = "<bsdf type=\"blendbsdf\">" + picture("weight") +
                              "<bsdf type=\"diffuse\"/><bsdf type=\"roughconductor\"/></bsdf>";
    const Scene old = loadOld(rectangleOf(blend)), later = loadInside(rectangleOf(blend));
    const auto share = [](const Scene& scene) {
        return shown(scene, scene.materials.at(scene.triangles.at(0).material)).x;
    };
    EXPECT_NEAR(share(old), mean, 1e-3);
    const double luminance =
        0.212671 * srgbToLinear(200 / 255.0) + 0.715160 * srgbToLinear(100 / 255.0);
    EXPECT_NEAR(share(later), luminance, 1e-3);
    EXPECT_GT(mean, luminance + 0.01);
    const std::string red = "<rgb name=\"color{}\" value=\"0.9, 0, 0\"/>";
    const Scene board = loadOld(
        rectangleOf("<bsdf type=\"blendbsdf\"><texture type=\"checkerboard\" name=\"weight\">" +
                    fmt::format(fmt::runtime(red), 0) + fmt::format(fmt::runtime(red), 1) +
                    "</texture><bsdf type=\"diffuse\"/><bsdf type=\"roughconductor\"/></bsdf>"));
    EXPECT_NEAR(share(board), 0.3, 1e-3);
}

TEST(MitsubaOldPictures, MasksHaveOneOpacity) {
    const auto problem = [](const std::string& opacity) {
        return problemInOld(
            rectangleOf("<bsdf type=\"mask\">" + opacity + "<bsdf type=\"diffuse\"/></bsdf>"));
    };
    const char* differs = "'opacity' differs between red, green and blue";
    EXPECT_THAT(problem(picture("opacity")), HasSubstr(differs));
    EXPECT_THAT(problem("<rgb name=\"opacity\" value=\"0.1, 0.5, 0.9\"/>"), HasSubstr(differs));
    EXPECT_THAT(problem(picture("opacity", "<string name=\"channel\" value=\"r\"/>")), IsEmpty());
    EXPECT_THAT(problem("<rgb name=\"opacity\" value=\"0.5\"/>"), IsEmpty());
}

TEST(MitsubaOldPictures, WiresAreOfTheColorBetweenThem) {
    const std::string wire = "<bsdf type=\"diffuse\"><texture type=\"wireframe\" "
                             "name=\"reflectance\"><rgb name=\"edgeColor\" value=\"0.9\"/>{}"
                             "</texture></bsdf>";
    const auto albedo = [&](const std::string& inside) {
        return loadOld(rectangleOf(fmt::format(fmt::runtime(wire), inside))).materials.at(0).albedo;
    };
    EXPECT_EQ(albedo("<rgb name=\"interiorColor\" value=\"0.25\"/>"), glm::vec3(0.25f));
    EXPECT_EQ(albedo(""), glm::vec3(0.5f));
}

/// Neither turns normals nor darkens what they say, as Mitsuba 3 does.
TEST(MitsubaOldPictures, ReliefHasNoRulesOfLaterVersions) {
    for (const std::string type : {"bumpmap", "normalmap"}) {
        const std::string relief = "<bsdf type=\"" + type + "\">" + picture("normalmap") +
                                   "<bsdf type=\"diffuse\"/></bsdf>";
        const Material old = loadOld(rectangleOf(relief)).materials.at(0);
        EXPECT_EQ(old.reliefRule, ReliefRule::Blacken) << type;
        EXPECT_FALSE(old.reliefShadows) << type;
        const Material later = loadInside(rectangleOf(relief)).materials.at(0);
        EXPECT_EQ(later.reliefRule, ReliefRule::Flip) << type;
        EXPECT_TRUE(later.reliefShadows) << type;
    }
}

TEST(MitsubaOldPictures, AroundTheSceneEndAtThePoles) {
    const std::vector<std::array<uint8_t, 4>> grey(4, {200, 200, 200, 255});
    const Scene scene =
        loadOld("<emitter type=\"envmap\"><string name=\"filename\" value=\"" +
                writePicture("rows.tga", 2, 2, grey) + "\"/></emitter>" + rectangleOf(""));
    EXPECT_EQ(scene.environment->height, 2u);
    EXPECT_FALSE(scene.environment->rowsReachPoles) << "their middles are half a row away";
}

TEST(MitsubaOldPictures, AroundTheSceneHaveAGamma) {
    const auto radiance = [](const std::string& inside) {
        const Scene scene =
            loadOld("<emitter type=\"envmap\"><string name=\"filename\" value=\"" +
                    writePicture("around.tga", 2, 1, {{200, 100, 0, 255}, {200, 100, 0, 255}}) +
                    "\"/>" + inside + "</emitter>" + rectangleOf(""));
        EXPECT_THAT(scene.report.forgiven, IsEmpty());
        return glm::dvec3(scene.environment->radiance.at(0));
    };
    EXPECT_NEAR(radiance("").x, srgbToLinear(200 / 255.0), 1e-5);
    EXPECT_NEAR(radiance(number("gamma", -1)).x, srgbToLinear(200 / 255.0), 1e-5);
    EXPECT_NEAR(radiance(number("gamma", 1)).y, 100 / 255.0, 1e-5);
    EXPECT_NEAR(radiance(number("gamma", 1.8)).y, std::pow(100 / 255.0, 1.8), 1e-5);
}

TEST(MitsubaOldPictures, SharesOfSamplesChangeNothing) {
    const Scene scene = loadOld(
        rectangleOf("<bsdf type=\"plastic\">" + number("specularSamplingWeight", 0.7) + "</bsdf>"));
    EXPECT_THAT(scene.report.forgiven, IsEmpty());
}

TEST(MitsubaOldPictures, MetalsHaveASecondTable) {
    const auto metal = [](const char* name) {
        return loadOld(rectangleOf(fmt::format("<bsdf type=\"conductor\"><string name=\"material\" "
                                               "value=\"{}\"/></bsdf>",
                                               name)));
    };
    EXPECT_EQ(metal("Na_palik").materials.at(0).k, metal("Na").materials.at(0).k);
    EXPECT_THAT(metal("Na_palik").report.forgiven, ElementsAre(HasSubstr("takes its place: Na")));
    EXPECT_EQ(metal("Xx_palik").materials.at(0).k, metal("Cu").materials.at(0).k);
}

} // namespace
} // namespace stromboli::test
