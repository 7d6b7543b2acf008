#include "scene/mitsuba/sunsky.hpp"

#include "scene/build/vectors.hpp"
#include "scene/mitsuba/colors.hpp"
#include "scene/mitsuba/sun_position.hpp"
#include "scene/sky/sun_sky.hpp"

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

namespace stromboli::mitsuba {
namespace {

using sky::SunSky;

glm::dvec3 albedoOf(const Plugin& emitter) {
    const glm::dvec3 usual(emitter.isOld ? 0.2 : 0.3);
    const std::optional<glm::dvec3> stated = colorOf(emitter, "albedo", ColorOf::Reflectance);
    if (!stated && emitter.child("albedo"))
        emitter.replaceParameter("albedo", build::Shortfall::Word,
                                 "is a texture, expected a colour");
    const glm::dvec3 albedo = stated.value_or(usual);
    for (int c = 0; c < 3; ++c)
        if (!(albedo[c] >= 0 && albedo[c] <= 1))
            emitter.replaceParameter("albedo", build::Shortfall::Number,
                                     fmt::format("is {}, expected 0 to 1", albedo[c]));
    return glm::clamp(albedo, 0.0, 1.0);
}

/// The sky of Mitsuba 0.x has its zenith at y; here it is z.
const glm::dmat3 kFromOldSky(glm::dvec3(1, 0, 0), glm::dvec3(0, 0, 1), glm::dvec3(0, -1, 0));

/// By the place and the time. In the old sky north is at -z, and east at x.
glm::dvec3 sunByTime(const Plugin& emitter) {
    const glm::dvec3 d = sunDirection(readSunTime(emitter));
    return emitter.isOld ? kFromOldSky * glm::dvec3(-d.y, d.z, d.x) : d;
}

glm::dvec3 sunOf(const Plugin& emitter, const glm::dmat3& skyFromFile) {
    const std::optional<glm::dvec3> stated = emitter.vector("sun_direction");
    if (!stated) return sunByTime(emitter);
    if (statesSunTime(emitter))
        emitter.replaceParameter("sun_direction", build::Shortfall::Parameter,
                                 "is stated beside a place or time, which are not heeded");
    const std::optional<glm::dvec3> sun = build::unit(skyFromFile * *stated);
    if (sun) return *sun;
    emitter.replaceParameter("sun_direction", build::Shortfall::Word, "has no length");
    return sunByTime(emitter);
}

/// Radians. In Mitsuba 0.x a scale makes the sun larger, which brings no more light.
double halfApertureOf(const Plugin& emitter) {
    constexpr double kUsual = 0.5358; // degrees
    if (emitter.isOld)
        return glm::radians(
            std::min(kUsual / 2 * emitter.number("sun_radius_scale", 0).value_or(1), 89.0));
    double aperture = emitter.number("sun_aperture").value_or(kUsual);
    if (!(aperture > 0 && aperture < 180)) {
        emitter.replaceParameter(
            "sun_aperture", build::Shortfall::Word,
            fmt::format("is {}, expected more than 0 and less than 180", aperture));
        aperture = kUsual;
    }
    return glm::radians(aperture / 2);
}

SunSky sunSkyOf(const Context& context, const Plugin& emitter) {
    SunSky s;
    s.turbidity = emitter.number("turbidity", 1, 10).value_or(s.turbidity);
    const double scale = emitter.isOld ? emitter.number("scale", 0).value_or(1) : 1;
    s.sunScale = emitter.number("sun_scale", 0).value_or(scale);
    s.skyScale = emitter.number("sky_scale", 0).value_or(scale);
    if (emitter.type == "sky") s.sunScale = 0;
    if (emitter.type == "sun") s.skyScale = 0;
    s.halfAperture = halfApertureOf(emitter);
    s.goesOn = emitter.isOld && emitter.flag("extend").value_or(false);
    s.albedo = albedoOf(emitter);
    const glm::dmat3 toFile(emitter.transform("to_world"));
    if (!(std::abs(glm::determinant(toFile)) > 0)) emitter.fail("to_world", "has no inverse");
    const glm::dmat3 skyFromFile =
        emitter.isOld ? kFromOldSky * glm::inverse(toFile) : glm::inverse(toFile);
    s.sun = sunOf(emitter, skyFromFile);
    s.skyFromWorld = skyFromFile * glm::transpose(glm::dmat3(context.worldFromFile));
    return s;
}

/// A sun without a disk shines in one direction.
void placeSun(Context& context, const SunSky& s, const glm::dvec3& irradiance) {
    Light light;
    light.name = "sun";
    light.kind = LightKind::Directional;
    light.color = glm::vec3(irradiance);
    const glm::dvec3 z = glm::normalize(glm::inverse(s.skyFromWorld) * s.sun);
    const glm::dvec3 other = std::abs(z.x) < 0.9 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 x = glm::normalize(glm::cross(other, z));
    context.builder.placeLight(std::move(light), {glm::dvec4(x, 0), glm::dvec4(glm::cross(z, x), 0),
                                                  glm::dvec4(z, 0), glm::dvec4(0, 0, 0, 1)});
}

} // namespace

void setSunSky(Context& context, const Plugin& emitter) {
    const SunSky s = sunSkyOf(context, emitter);
    emitter.skip("complex_sun"); // the disk's edge is darker: its mean stays
    emitter.skip("resolution");
    Environment environment;
    environment.name = emitter.type;
    if (s.sun.z < 0) {
        context.report().warn(
            fmt::format("the sun of {} is below the horizon: its sky is black", emitter.type));
        context.builder.setEnvironment(std::move(environment));
        return;
    }
    const glm::dvec3 irradiance = sky::sunIrradiance(s, emitter.isOld);
    environment = sky::sunSkyPicture(s, irradiance);
    environment.name = emitter.type;
    if (s.sunScale > 0 && s.halfAperture <= 0) placeSun(context, s, irradiance);
    context.builder.setEnvironment(std::move(environment));
}

} // namespace stromboli::mitsuba
