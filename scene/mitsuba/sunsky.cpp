#include "scene/mitsuba/sunsky.hpp"

#include "scene/build/vectors.hpp"
#include "scene/mitsuba/colors.hpp"
#include "scene/mitsuba/sky_model.hpp"
#include "scene/mitsuba/sun_position.hpp"
#include "scene/mitsuba/sun_radiance.hpp"

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <cmath>

namespace stromboli::mitsuba {
namespace {

/// Texels of 0.18 degrees: three across the sun. A sky alone changes slowly.
constexpr uint32_t kWidthWithSun = 2048, kWidthOfSky = 512;

/// What the plugin says. Directions are in the sky's own space, z up.
struct SunSky {
    double turbidity = 3, sunScale = 1, skyScale = 1;
    double halfAperture = 0; ///< of the sun, radians
    bool goesOn = false;     ///< below the horizon, ever darker
    glm::dvec3 albedo{0.3};
    glm::dvec3 sun{0, 0, 1};
    glm::dmat3 skyFromWorld{1.0};
};

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

/// The directions and solid angles of the texels of a picture around the world, as Environment has
/// them.
struct PictureAround {
    uint32_t width, height;

    /// column and row: 0 to the width and height.
    glm::dvec3 direction(double column, double row) const {
        const double turn = glm::two_pi<double>() * (column / width - 0.5);
        const double down = glm::pi<double>() * row / height;
        return {std::sin(down) * std::sin(turn), std::cos(down), -std::sin(down) * std::cos(turn)};
    }
    size_t texelAt(const glm::dvec3& direction) const {
        const double turn = std::atan2(direction.x, -direction.z);
        const double down = std::acos(std::clamp(direction.y, -1.0, 1.0));
        const auto column = int64_t((turn / glm::two_pi<double>() + 0.5) * width);
        const auto row = int64_t(down / glm::pi<double>() * height);
        return size_t(std::clamp<int64_t>(row, 0, height - 1)) * width +
               size_t(std::clamp<int64_t>(column, 0, width - 1));
    }
    double solidAngle(size_t texel) const {
        const double step = glm::pi<double>() / height;
        const double top = double(texel / width) * step;
        return glm::two_pi<double>() / width * (std::cos(top) - std::cos(top + step));
    }
};

/// Below the horizon there is nothing, or what is at the horizon, ever darker.
glm::vec3 skyIn(const SunSky& s, const SkyModel& model, const glm::dvec3& d) {
    glm::dvec3 seen = d;
    double share = 1;
    if (!(d.z >= 0)) {
        const double across = std::hypot(d.x, d.y);
        if (!s.goesOn || !(across > 0)) return glm::vec3(0);
        seen = glm::dvec3(d.x / across, d.y / across, 0);
        share = glm::smoothstep(0.0, 1.0, 2 - 2 * std::acos(d.z) / glm::pi<double>());
    }
    const double fromSun = std::acos(std::clamp(glm::dot(seen, s.sun), -1.0, 1.0));
    return glm::vec3(share * s.skyScale * model.sky(seen.z, fromSun));
}

void addSky(const SunSky& s, const SkyModel& model, const PictureAround& around,
            std::vector<glm::vec3>& picture) {
    for (uint32_t row = 0; row < around.height; ++row)
        for (uint32_t column = 0; column < around.width; ++column) {
            const glm::dvec3 d =
                glm::normalize(s.skyFromWorld * around.direction(column + 0.5, row + 0.5));
            picture[size_t(row) * around.width + column] += skyIn(s, model, d);
        }
}

double solidAngleOf(double halfAperture) {
    return 2 * glm::two_pi<double>() * std::pow(std::sin(halfAperture / 2), 2);
}

/// What the sun brings is that of the real one, however large its disk is here.
glm::dvec3 sunIrradiance(const Plugin& emitter, const SunSky& s, const SkyModel& model) {
    const glm::dvec3 radiance =
        emitter.isOld ? sunRadiance(std::acos(std::clamp(s.sun.z, 0.0, 1.0)), s.turbidity)
                      : model.sun();
    return s.sunScale * radiance * solidAngleOf(SkyModel::halfSun());
}

/// Deals the sun's light out to the texels that points of its disk, of equal parts, lie in: all of
/// it, however small the disk is.
void addSun(const SunSky& s, const glm::dvec3& irradiance, const PictureAround& around,
            std::vector<glm::vec3>& picture) {
    constexpr int kRings = 256, kPerRing = 256;
    const glm::dvec3 each = irradiance / double(kRings * kPerRing);
    const glm::dvec3 other = std::abs(s.sun.z) < 0.9 ? glm::dvec3(0, 0, 1) : glm::dvec3(1, 0, 0);
    const glm::dvec3 x = glm::normalize(glm::cross(other, s.sun)), y = glm::cross(s.sun, x);
    const glm::dmat3 worldFromSky = glm::inverse(s.skyFromWorld);
    for (int ring = 0; ring < kRings; ++ring) {
        // Equal steps of the cosine are equal parts of the cap.
        const double part = (ring + 0.5) / kRings * std::pow(std::sin(s.halfAperture / 2), 2);
        const double away = 2 * std::asin(std::sqrt(part));
        for (int i = 0; i < kPerRing; ++i) {
            const double turn = glm::two_pi<double>() * (i + 0.5) / kPerRing;
            const glm::dvec3 d =
                std::cos(away) * s.sun + std::sin(away) * (std::cos(turn) * x + std::sin(turn) * y);
            if (!(d.z >= 0)) continue;
            const size_t texel = around.texelAt(glm::normalize(worldFromSky * d));
            picture[texel] += glm::vec3(each / around.solidAngle(texel));
        }
    }
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
    const bool hasDisk = s.sunScale > 0 && s.halfAperture > 0;
    const uint32_t width = hasDisk ? kWidthWithSun : kWidthOfSky;
    const PictureAround around{width, width / 2};
    environment.width = around.width;
    environment.height = around.height;
    environment.radiance.assign(size_t(around.width) * around.height, glm::vec3(0));
    const SkyModel model(s.turbidity, s.albedo, std::asin(std::min(s.sun.z, 1.0)));
    if (s.skyScale > 0) addSky(s, model, around, environment.radiance);
    const glm::dvec3 irradiance = sunIrradiance(emitter, s, model);
    if (hasDisk) addSun(s, irradiance, around, environment.radiance);
    if (s.sunScale > 0 && !hasDisk) placeSun(context, s, irradiance);
    context.builder.setEnvironment(std::move(environment));
}

} // namespace stromboli::mitsuba
