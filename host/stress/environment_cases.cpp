// Light from infinity that is nearly all in one place.
#include "host/stress/case.hpp"
#include "host/stress/scenes.hpp"
#include "host/stress/totals.hpp"

#include <fmt/format.h>

#include <cmath>

namespace stromboli::stress {
namespace {

constexpr uint32_t kSkyWidth = 32, kSkyHeight = 16;
constexpr double kTexelAngle = M_PI / kSkyHeight; ///< a texel's height; its width is the same angle

/// Integrals of w(theta) sin(theta) cos(theta) and w(theta) sin(theta)^2 over the polar angle, w
/// the weight of a row: a tent of one step about its middle c. With cos(2 theta) about c, and the
/// transform of a tent, they are sin(2 c) sin(step)^2 / (2 step) and
/// (step - cos(2 c) sin(step)^2 / step) / 2. Above its middle the weight of the first row stays 1.
glm::dvec2 rowIntegrals(uint32_t row) {
    const double d = kTexelAngle;
    if (row == 0)
        return {0.25 - (std::sin(3 * d) - std::sin(d)) / (8 * d),
                d / 2 - (std::cos(d) - std::cos(3 * d)) / (8 * d)};
    const double c = (row + 0.5) * d, transform = std::sin(d) * std::sin(d) / d;
    return {std::sin(2 * c) * transform / 2, (d - std::cos(2 * c) * transform) / 2};
}

/// Irradiance by a texel of radiance 1, all of whose tent lies above the surface.
double irradianceBy(uint32_t row, uint32_t column, const glm::dvec3& normal) {
    const double half =
        std::sin(kTexelAngle / 2) / (kTexelAngle / 2); // of the tent over azimuths, squared
    const double azimuth = (column + 0.5) * kTexelAngle;
    const glm::dvec2 polar = rowIntegrals(row);
    return normal.y * polar.x * kTexelAngle +
           (normal.z * std::cos(azimuth) - normal.x * std::sin(azimuth)) * polar.y * kTexelAngle *
               half * half;
}

/// An environment of 1, but for one texel of 1e6, and a plane: pi and what the texel adds.
Finding onePixelSun(Run& run) {
    constexpr float kSun = 1e6f;
    struct Place {
        const char* name;
        uint32_t row, column;
        DirectLight whenQuick; ///< the one way to find it in a quick run
    };
    constexpr uint32_t kRow = kSkyHeight / 4;
    const Place places[] = {{"the pole", 0, 5, DirectLight::Lights},
                            {"the left edge", kRow, 0, DirectLight::MisAll},
                            {"the right edge", kRow, kSkyWidth - 1, DirectLight::Lights},
                            {"mid height", kRow, 3, DirectLight::Bsdf}};
    // Tilted towards the left edge, so that all are above it and none is where another would be.
    const glm::dvec3 normal = glm::dvec3(-2, 6, 3) / 7.0, along = glm::dvec3(3, 2, -2);
    const glm::dvec3 across = glm::cross(normal, along);
    Finding f;
    f.bound = 4.5; // a right renderer fails once in 1e5 times
    for (const Place& place : places) {
        SceneMaker m;
        m.quad(glm::vec3(-0.5 * (along + across)), glm::vec3(along), glm::vec3(across),
               m.add(diffuse(0.5f)));
        Environment sky;
        sky.width = kSkyWidth, sky.height = kSkyHeight;
        sky.radiance.assign(size_t(kSkyWidth) * kSkyHeight, glm::vec3(1));
        sky.radiance[place.row * kSkyWidth + place.column] = glm::vec3(kSun);
        m.scene.environment = sky;
        const double expected =
            0.5 / M_PI *
            (M_PI + (double(kSun) - 1) * irradianceBy(place.row, place.column, normal));
        for (const DirectLight mode :
             {DirectLight::Lights, DirectLight::MisAll, DirectLight::Bsdf}) {
            if (run.quick() && mode != place.whenQuick) continue;
            RenderSettings s = picture(16, run.amount(64u, 4096u), 1);
            s.estimator.directLight = mode;
            const Totals found(run.render(m.scene, lookingAt(normal, {0, 0, 0}, 0.1), s).film);
            const double z = sigmasOff(found, glm::dvec3(expected));
            if (!(z <= f.measured))
                f.measured = z, f.where = fmt::format("{}, {}", place.name, nameOf(mode));
            f.trials += found.all.taken();
        }
    }
    return f;
}

} // namespace

std::vector<Case> environmentCases() {
    return {{"one-pixel-sun", "53", "one texel 1e6 times as bright as the sky: its irradiance",
             "sigma", "samples", onePixelSun}};
}

} // namespace stromboli::stress
