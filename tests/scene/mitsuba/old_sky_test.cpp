// The sky and the sun of Mitsuba 0.x: y is up, and the sun is Preetham's.

#include "scene/sky/sun_radiance.hpp"
#include "tests/scene/mitsuba/mitsuba_text.hpp"

#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>

#include <cmath>

namespace stromboli::test {
namespace {

using testing::HasSubstr;
using testing::IsEmpty;

/// The irradiance of all that exceeds the sky, and where it is: the brightest texel's direction.
struct Sun {
    glm::dvec3 irradiance{0.0}, direction{0.0};
};

glm::dvec3 directionOf(const Environment& e, size_t texel) {
    const double turn = glm::two_pi<double>() * ((double(texel % e.width) + 0.5) / e.width - 0.5);
    const double down = glm::pi<double>() * (double(texel / e.width) + 0.5) / e.height;
    return {std::sin(down) * std::sin(turn), std::cos(down), -std::sin(down) * std::cos(turn)};
}

double solidAngleOf(const Environment& e, size_t texel) {
    const double step = glm::pi<double>() / e.height, top = double(texel / e.width) * step;
    return glm::two_pi<double>() / e.width * (std::cos(top) - std::cos(top + step));
}

Sun sunOf(const Environment& e) {
    Sun sun;
    size_t brightest = 0;
    for (size_t i = 0; i < e.radiance.size(); ++i) {
        if (e.radiance[i].y > e.radiance[brightest].y) brightest = i;
        sun.irradiance += glm::dvec3(e.radiance[i]) * solidAngleOf(e, i);
    }
    sun.direction = directionOf(e, brightest);
    return sun;
}

Environment environmentOf(const std::string& type, const std::string& inside) {
    const Scene scene = loadOld("<emitter type=\"" + type + "\">" + inside + "</emitter>");
    EXPECT_THAT(scene.report.forgiven, IsEmpty());
    return scene.environment.value();
}

double angle(const glm::dvec3& a, const glm::dvec3& b) {
    return std::acos(std::clamp(glm::dot(glm::normalize(a), glm::normalize(b)), -1.0, 1.0));
}

std::string vectorOf(const char* name, const glm::dvec3& v) {
    return std::string("<vector name=\"") + name + "\" x=\"" + std::to_string(v.x) + "\" y=\"" +
           std::to_string(v.y) + "\" z=\"" + std::to_string(v.z) + "\"/>";
}

/// The sun of a clear day brings about 100,000 lux: 683 lm/W, times 106.9 nm of the curve for
/// light.
TEST(MitsubaOldSky, ItsSunIsAsBrightAsTheSun) {
    const double halfSun = glm::radians(0.5358 / 2);
    const double solidAngle = 2 * glm::pi<double>() * (1 - std::cos(halfSun));
    const auto luminance = [](const glm::dvec3& rgb) {
        return glm::dot(rgb, glm::dvec3(0.2126, 0.7152, 0.0722));
    };
    const double lux =
        683 * 106.9 * luminance(sky::sunRadiance(glm::radians(30.0), 2)) * solidAngle;
    EXPECT_GT(lux, 80e3);
    EXPECT_LT(lux, 130e3);
    const glm::dvec3 noon = sky::sunRadiance(0, 3), dusk = sky::sunRadiance(1.5, 3);
    EXPECT_GT(noon.y, 4 * dusk.y);
    EXPECT_GT(dusk.x / dusk.z, 4 * noon.x / noon.z); // red
}

TEST(MitsubaOldSky, StandsUprightInY) {
    const glm::dvec3 towards(0.3, 0.6, -0.5);
    const Environment e = environmentOf("sunsky", vectorOf("sunDirection", towards));
    EXPECT_LT(angle(sunOf(e).direction, towards), glm::radians(0.4));
    for (size_t i = e.radiance.size() / 2; i < e.radiance.size(); ++i)
        ASSERT_EQ(e.radiance[i], glm::vec3(0)) << "below the horizon";
    EXPECT_GT(e.radiance[e.radiance.size() / 4].z, 0);
}

/// sunDirection is in the world, whatever toWorld turns: the scene is turned with the sky, y up.
TEST(MitsubaOldSky, TheSunsDirectionIsInTheWorld) {
    const std::string turned = "<transform name=\"toWorld\"><rotate x=\"1\" angle=\"90\"/>"
                               "</transform>"; // the sky's zenith is z
    const Environment e =
        environmentOf("sunsky", turned + vectorOf("sunDirection", {0.5, 0.3, 0.4}));
    // World (x, y, z) is (x, z, -y) where y is up.
    EXPECT_LT(angle(sunOf(e).direction, {0.5, 0.4, -0.3}), glm::radians(0.4));
}

/// Tokyo at noon in July: the sun is high, in the south, which is z; in the morning in the east: x.
TEST(MitsubaOldSky, NorthIsAwayFromZ) {
    const auto sun = [](const std::string& hour) {
        return sunOf(environmentOf("sun", "<float name=\"hour\" value=\"" + hour + "\"/>"))
            .direction;
    };
    const glm::dvec3 noon = sun("11.75"), morning = sun("7");
    EXPECT_GT(noon.y, 0.95);
    EXPECT_GT(noon.z, 0.1);
    EXPECT_GT(morning.x, 0.7);
    EXPECT_GT(morning.y, 0.2);
}

TEST(MitsubaOldSky, ALargerSunBringsAsMuch) {
    const std::string place = vectorOf("sunDirection", {0.3, 0.6, -0.5});
    const auto irradiance = [&](const std::string& scale) {
        return sunOf(environmentOf("sun", place + "<float name=\"sunRadiusScale\" value=\"" +
                                              scale + "\"/>"))
            .irradiance.y;
    };
    const double usual = irradiance("1");
    EXPECT_NEAR(irradiance("10") / usual, 1, 1e-3);
    const Scene distant = loadOld("<emitter type=\"sun\">" + place +
                                  "<float name=\"sunRadiusScale\" value=\"0\"/></emitter>");
    ASSERT_EQ(distant.lights.size(), 1u);
    EXPECT_EQ(distant.lights[0].kind, LightKind::Directional);
    EXPECT_NEAR(distant.lights[0].color.y / usual, 1, 1e-3);
    EXPECT_LT(angle(distant.lights[0].direction, {-0.3, -0.6, 0.5}), 1e-5);
}

TEST(MitsubaOldSky, ScalesAndParts) {
    const std::string place = vectorOf("sunDirection", {0.3, 0.6, -0.5});
    const auto irradiance = [&](const std::string& type, const std::string& scales) {
        return sunOf(environmentOf(type, place + scales)).irradiance.z;
    };
    const auto scale = [](const char* name, const char* value) {
        return std::string("<float name=\"") + name + "\" value=\"" + value + "\"/>";
    };
    const double sky = irradiance("sky", ""), sun = irradiance("sun", "");
    EXPECT_GT(sky, 0);
    EXPECT_GT(sun, 0);
    EXPECT_NEAR(irradiance("sunsky", "") / (sky + sun), 1, 1e-2);
    EXPECT_NEAR(irradiance("sunsky", scale("scale", "3")) / (sky + sun), 3, 3e-2);
    EXPECT_NEAR(irradiance("sunsky", scale("skyScale", "2") + scale("sunScale", "0")) / sky, 2,
                2e-2);
    EXPECT_NEAR(irradiance("sky", scale("scale", "0.5")) / sky, 0.5, 1e-3);
    EXPECT_GT(irradiance("sky", scale("turbidity", "8")), sky);
    EXPECT_GT(irradiance("sky", "<boolean name=\"extend\" value=\"true\"/>"), 1.2 * sky);
}

} // namespace
} // namespace stromboli::test
