#include "scene/mitsuba/sunsky.hpp"

#include "scene/build/vectors.hpp"
#include "scene/mitsuba/colors.hpp"
#include "scene/mitsuba/sky_model.hpp"
#include "scene/mitsuba/sun_position.hpp"

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
    glm::dvec3 albedo{0.3};
    glm::dvec3 sun{0, 0, 1};
    glm::dmat3 skyFromWorld{1.0};
};

glm::dvec3 albedoOf(const Plugin& emitter) {
    const std::optional<glm::dvec3> stated = colorOf(emitter, "albedo", ColorOf::Reflectance);
    if (!stated && emitter.child("albedo"))
        emitter.fail("albedo", "is a texture, expected a colour");
    const glm::dvec3 albedo = stated.value_or(glm::dvec3(0.3));
    for (int c = 0; c < 3; ++c)
        if (!(albedo[c] >= 0 && albedo[c] <= 1))
            emitter.fail("albedo", fmt::format("is {}, expected 0 to 1", albedo[c]));
    return albedo;
}

glm::dvec3 sunOf(const Plugin& emitter, const glm::dmat3& skyFromFile) {
    const std::optional<glm::dvec3> stated = emitter.vector("sun_direction");
    if (!stated) return sunDirection(readSunTime(emitter));
    if (statesSunTime(emitter))
        emitter.fail("sun_direction", "is stated beside a place or time, expected one of both");
    const std::optional<glm::dvec3> sun = build::unit(skyFromFile * *stated);
    if (!sun) emitter.fail("sun_direction", "has no length");
    return *sun;
}

SunSky sunSkyOf(const Context& context, const Plugin& emitter) {
    SunSky s;
    s.turbidity = emitter.number("turbidity", 1, 10).value_or(s.turbidity);
    s.sunScale = emitter.number("sun_scale", 0).value_or(s.sunScale);
    s.skyScale = emitter.number("sky_scale", 0).value_or(s.skyScale);
    const double aperture = emitter.number("sun_aperture", 0, 180).value_or(0.5358);
    if (!(aperture > 0 && aperture < 180))
        emitter.fail("sun_aperture",
                     fmt::format("is {}, expected more than 0 and less than 180", aperture));
    s.halfAperture = glm::radians(aperture / 2);
    s.albedo = albedoOf(emitter);
    const glm::dmat3 toFile(emitter.transform("to_world"));
    if (!(std::abs(glm::determinant(toFile)) > 0)) emitter.fail("to_world", "has no inverse");
    const glm::dmat3 skyFromFile = glm::inverse(toFile);
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

void addSky(const SunSky& s, const SkyModel& model, const PictureAround& around,
            std::vector<glm::vec3>& picture) {
    for (uint32_t row = 0; row < around.height; ++row)
        for (uint32_t column = 0; column < around.width; ++column) {
            const glm::dvec3 d =
                glm::normalize(s.skyFromWorld * around.direction(column + 0.5, row + 0.5));
            if (!(d.z >= 0)) continue; // below the horizon there is nothing
            const double fromSun = std::acos(std::clamp(glm::dot(d, s.sun), -1.0, 1.0));
            picture[size_t(row) * around.width + column] +=
                glm::vec3(s.skyScale * model.sky(d.z, fromSun));
        }
}

/// Deals the sun's light out to the texels that points of its disk, of equal parts, lie in: all of
/// it, however small the disk is.
void addSun(const SunSky& s, const SkyModel& model, const PictureAround& around,
            std::vector<glm::vec3>& picture) {
    constexpr int kRings = 256, kPerRing = 256;
    const auto solidAngleOf = [](double half) {
        return 2 * glm::two_pi<double>() * std::pow(std::sin(half / 2), 2);
    };
    // What it brings is that of the real sun, however large the disk is.
    const glm::dvec3 each =
        s.sunScale * model.sun() * solidAngleOf(SkyModel::halfSun()) / double(kRings * kPerRing);
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

} // namespace

void setSunSky(Context& context, const Plugin& emitter) {
    const SunSky s = sunSkyOf(context, emitter);
    emitter.skip("complex_sun"); // the disk's edge is darker: its mean stays
    Environment environment;
    environment.name = "sunsky";
    if (s.sun.z < 0) {
        context.report().warn("the sun of sunsky is below the horizon: its sky is black");
        context.builder.setEnvironment(std::move(environment));
        return;
    }
    const uint32_t width = s.sunScale > 0 ? kWidthWithSun : kWidthOfSky;
    const PictureAround around{width, width / 2};
    environment.width = around.width;
    environment.height = around.height;
    environment.radiance.assign(size_t(around.width) * around.height, glm::vec3(0));
    const SkyModel model(s.turbidity, s.albedo, std::asin(std::min(s.sun.z, 1.0)));
    if (s.skyScale > 0) addSky(s, model, around, environment.radiance);
    if (s.sunScale > 0) addSun(s, model, around, environment.radiance);
    context.builder.setEnvironment(std::move(environment));
}

} // namespace stromboli::mitsuba
