// What shines.

#include "tests/scene/mitsuba/mitsuba_text.hpp"

#include <glm/gtc/constants.hpp>

namespace stromboli::test {
namespace {

using testing::HasSubstr;

TEST(MitsubaEmitters, Points) {
    const Scene scene = loadInside("<emitter type=\"point\"><rgb name=\"intensity\" value=\"3\"/>"
                                   "<point name=\"position\" x=\"1\" y=\"2\" z=\"3\"/></emitter>");
    const Light& light = scene.lights.at(0);
    EXPECT_EQ(light.kind, LightKind::Point);
    EXPECT_EQ(light.color, glm::vec3(3));
    EXPECT_EQ(light.position, glm::vec3(1, 2, 3));
    EXPECT_EQ(light.constantAttenuation, 0);
    EXPECT_EQ(light.quadraticAttenuation, 1);
}

TEST(MitsubaEmitters, SpectraOfLightHaveThePowerAtEveryWavelength) {
    const Scene scene = loadInside("<emitter type=\"point\"><spectrum name=\"intensity\" "
                                   "value=\"2\"/></emitter>");
    EXPECT_EQ(scene.lights.at(0).color, glm::vec3(2.4096f, 1.8966f, 1.8178f));
}

TEST(MitsubaEmitters, DirectionsAreThoseOfTheLight) {
    const Scene scene = loadInside("<emitter type=\"directional\"><vector name=\"direction\" "
                                   "value=\"0,0,-2\"/></emitter>"
                                   "<emitter type=\"directional\"><transform name=\"to_world\">"
                                   "<lookat origin=\"0,0,0\" target=\"1,0,0\" up=\"0,1,0\"/>"
                                   "</transform></emitter>");
    EXPECT_NEAR(glm::distance(scene.lights.at(0).direction, glm::vec3(0, 0, -1)), 0, 1e-6);
    EXPECT_NEAR(glm::distance(scene.lights.at(1).direction, glm::vec3(1, 0, 0)), 0, 1e-6);
}

TEST(MitsubaEmitters, Spots) {
    const Scene scene = loadInside("<emitter type=\"spot\"><float name=\"cutoff_angle\" "
                                   "value=\"40\"/></emitter>");
    EXPECT_FLOAT_EQ(scene.lights.at(0).falloffAngle, glm::radians(80.0f));
    EXPECT_FLOAT_EQ(scene.lights.at(0).innerAngle.value(), glm::radians(60.0f));
    EXPECT_NEAR(glm::distance(scene.lights.at(0).direction, glm::vec3(0, 0, 1)), 0, 1e-6);
}

TEST(MitsubaEmitters, SpotsThrowPictures) {
    const Scene scene = loadInside("<emitter type=\"spot\"><float name=\"cutoff_angle\" "
                                   "value=\"45\"/><texture name=\"texture\" "
                                   "type=\"checkerboard\"/></emitter>");
    const Light& spot = scene.lights.at(0);
    EXPECT_EQ(spot.kind, LightKind::Projector);
    ASSERT_TRUE(spot.picture.has_value());
    EXPECT_EQ(spot.picture->slot, TextureSlot::Projection);
    EXPECT_FALSE(spot.isFramed);
    EXPECT_NEAR(glm::distance(spot.edgeX, glm::vec3(0.5f, 0, 0)), 0, 1e-6);
    EXPECT_NEAR(glm::distance(spot.edgeY, glm::vec3(0, 0.5f, 0)), 0, 1e-6);
    EXPECT_THAT(
        problemInside("<emitter type=\"spot\"><rgb name=\"texture\" value=\"1\"/></emitter>"),
        HasSubstr("is no picture, expected one"));
}

/// A camera's coordinates: u against x, v against y, from 0 to 1 over the angle of view.
TEST(MitsubaEmitters, ProjectorsAreCamerasTurnedRound) {
    const Scene scene = loadInside("<emitter type=\"projector\"><float name=\"fov\" value=\"90\"/>"
                                   "<rgb name=\"irradiance\" value=\"1 2 3\"/>"
                                   "<float name=\"scale\" value=\"2\"/></emitter>");
    const Light& light = scene.lights.at(0);
    EXPECT_EQ(light.kind, LightKind::Projector);
    EXPECT_TRUE(light.isFramed);
    EXPECT_NEAR(light.color.y, 4 * 3.14159265f, 1e-5f);
    EXPECT_NEAR(glm::distance(light.edgeX, glm::vec3(-0.5f, 0, 0)), 0, 1e-6);
    EXPECT_NEAR(glm::distance(light.edgeY, glm::vec3(0, -0.5f, 0)), 0, 1e-6);
    EXPECT_THAT(problemInside("<emitter type=\"projector\"/>"), HasSubstr("has no 'irradiance'"));
}

TEST(MitsubaEmitters, SurfacesShineInFront) {
    const Scene scene = loadInside("<shape type=\"rectangle\"><emitter type=\"area\">"
                                   "<rgb name=\"radiance\" value=\"1 2 3\"/></emitter></shape>");
    const Material& m = scene.materials.at(0);
    EXPECT_EQ(m.emission, glm::vec3(1, 2, 3));
    EXPECT_FALSE(m.emitsBothSides);
    EXPECT_EQ(m.albedo, glm::vec3(0));
    EXPECT_THAT(problemInside("<emitter type=\"area\"/>"), HasSubstr("expected it inside of a"));
}

/// It may stand in the scene, for shapes to refer to.
TEST(MitsubaEmitters, SurfacesMayReferToTheirLamp) {
    const std::string lamp = "<emitter type=\"area\" id=\"lamp\"/>";
    const std::string shape = "<shape type=\"rectangle\"><ref id=\"lamp\"/></shape>";
    for (const std::string& inside :
         {lamp + shape, lamp + "<shape type=\"merge\">" + shape + "</shape>"}) {
        EXPECT_EQ(problemInside(inside), "");
        EXPECT_EQ(loadInside(inside).materials.at(0).emission, glm::vec3(1));
    }
}

/// As Mitsuba has it: a lamp without a bsdf is black, other shapes are grey.
TEST(MitsubaEmitters, LampsReflectByTheirBsdfAlone) {
    const auto albedoOf = [](const std::string& inside) {
        const Scene scene = loadInside("<shape type=\"rectangle\">" + inside + "</shape>");
        return scene.materials.at(scene.triangles.at(0).material).albedo;
    };
    const std::string area = "<emitter type=\"area\"/>";
    EXPECT_EQ(albedoOf(area), glm::vec3(0));
    EXPECT_EQ(albedoOf(area + "<bsdf type=\"diffuse\"/>"), glm::vec3(0.5));
    EXPECT_EQ(albedoOf(""), glm::vec3(0.5));
}

TEST(MitsubaEmitters, BeamsAlongNormalsGiveNoLight) {
    const Scene scene = loadInside("<shape type=\"rectangle\"><emitter type=\"directionalarea\">"
                                   "<rgb name=\"radiance\" value=\"1, 2, 3\"/></emitter></shape>");
    EXPECT_FALSE(scene.materials.at(scene.triangles.at(0).material).emits());
    EXPECT_THAT(scene.report.warnings,
                testing::Contains(HasSubstr("'directionalarea' shines along its normals alone")));
    EXPECT_THAT(problemInside("<emitter type=\"directionalarea\"/>"),
                HasSubstr("expected it inside of a shape"));
}

TEST(MitsubaEmitters, ConstantEnvironments) {
    const Scene scene = loadInside("<emitter type=\"constant\"><rgb name=\"radiance\" value=\"2\"/>"
                                   "</emitter>");
    EXPECT_EQ(scene.environment.value().radiance.at(0), glm::vec3(2));
    EXPECT_THAT(problemInside("<emitter type=\"constant\"/>\n<emitter type=\"constant\"/>"),
                HasSubstr("3: <emitter>: is the second environment"));
}

/// A picture of two columns and three rows of which one texel is bright, in Radiance's format
/// without compression.
void writeEnvironment(int bright) {
    std::string text = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 3 +X 2\n";
    for (int i = 0; i < 6; ++i)
        text += i == bright ? std::string("\x80\x80\x80\x81", 4) : std::string(4, '\0');
    writeFile("sky.hdr", text);
}

TEST(MitsubaEmitters, EnvironmentRowsReachThePoles) {
    writeEnvironment(0); // the first row is at the pole
    const Scene scene = loadInside("<emitter type=\"envmap\"><string name=\"filename\" "
                                   "value=\"sky.hdr\"/></emitter>");
    const Environment& e = scene.environment.value();
    ASSERT_EQ(e.height, 3u);
    EXPECT_TRUE(e.rowsReachPoles);
    EXPECT_FLOAT_EQ(e.radiance[0].x, 1);
    EXPECT_EQ(e.radiance[2].x, 0);
    EXPECT_FLOAT_EQ(e.rotation, glm::pi<float>());
    writeFile("sky.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n" +
                             std::string("\x80\x80\x80\x81\x80\x80\x80\x81", 8));
    EXPECT_FALSE(loadInside("<emitter type=\"envmap\"><string name=\"filename\" "
                            "value=\"sky.hdr\"/></emitter>")
                     .environment->rowsReachPoles)
        << "one row has no poles to reach";
}

/// An environment that is turned turns the scene the other way: its own y stays up.
TEST(MitsubaEmitters, TurnedEnvironmentsTurnTheScene) {
    writeEnvironment(0);
    const std::string turned = "<emitter type=\"envmap\"><string name=\"filename\" "
                               "value=\"sky.hdr\"/><transform name=\"to_world\">"
                               "<rotate x=\"1\" angle=\"90\"/></transform></emitter>";
    const Scene scene = loadInside(turned + "<shape type=\"sphere\"><point name=\"center\" "
                                            "value=\"0 0 5\"/></shape>");
    EXPECT_NEAR(glm::distance(scene.spheres.at(0).center, glm::vec3(0, 5, 0)), 0, 1e-5);
}

TEST(MitsubaEmitters, UnknownOnesAreNamed) {
    EXPECT_THAT(
        problemInside("<emitter type=\"timed_sunsky\"/>"),
        HasSubstr("2: <emitter>: 'timed_sunsky' is no emitter that is read, expected point"));
}

} // namespace
} // namespace stromboli::test
