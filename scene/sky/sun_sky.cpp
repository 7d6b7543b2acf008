#include "scene/sky/sun_sky.hpp"

#include "scene/sky/sky_model.hpp"
#include "scene/sky/sun_radiance.hpp"

#include <glm/gtc/constants.hpp>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>

namespace stromboli::sky {
namespace {

/// Texels of 0.18 degrees: three across the sun. A sky alone changes slowly.
constexpr uint32_t kWidthWithSun = 2048, kWidthOfSky = 512;

/// The directions and solid angles of the texels of a picture around the world, as Environment has
/// them.
struct PictureAround {
    uint32_t width, height;

    /// Sine and cosine of how far a column lies from the middle, and a row from the top; 0 to the
    /// width and height.
    glm::dvec2 turnOf(double column) const {
        const double turn = glm::two_pi<double>() * (column / width - 0.5);
        return {std::sin(turn), std::cos(turn)};
    }
    glm::dvec2 downOf(double row) const {
        const double down = glm::pi<double>() * row / height;
        return {std::sin(down), std::cos(down)};
    }
    static glm::dvec3 direction(const glm::dvec2& turn, const glm::dvec2& down) {
        return {down.x * turn.x, down.y, -down.x * turn.y};
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
        const double across = std::sqrt(d.x * d.x + d.y * d.y);
        if (!s.goesOn || !(across > 0)) return glm::vec3(0);
        seen = glm::dvec3(d.x / across, d.y / across, 0);
        share = glm::smoothstep(0.0, 1.0, 2 - 2 * std::acos(d.z) / glm::pi<double>());
    }
    return glm::vec3(share * s.skyScale * model.sky(seen.z, glm::dot(seen, s.sun)));
}

void addSky(const SunSky& s, const SkyModel& model, const PictureAround& around,
            std::vector<glm::vec3>& picture) {
    std::vector<glm::dvec2> turns;
    for (uint32_t column = 0; column < around.width; ++column)
        turns.push_back(around.turnOf(column + 0.5));
    tbb::parallel_for(0u, around.height, [&](uint32_t row) {
        const glm::dvec2 down = around.downOf(row + 0.5);
        for (uint32_t column = 0; column < around.width; ++column) {
            const glm::dvec3 d =
                glm::normalize(s.skyFromWorld * PictureAround::direction(turns[column], down));
            picture[size_t(row) * around.width + column] += skyIn(s, model, d);
        }
    });
}

double solidAngleOf(double halfAperture) {
    return 2 * glm::two_pi<double>() * std::pow(std::sin(halfAperture / 2), 2);
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

} // namespace

glm::dvec3 sunIrradiance(const SunSky& s, bool byPreetham) {
    const double elevation = std::asin(std::clamp(s.sun.z, 0.0, 1.0));
    const glm::dvec3 radiance = byPreetham
                                    ? sunRadiance(glm::half_pi<double>() - elevation, s.turbidity)
                                    : SkyModel(s.turbidity, s.albedo, elevation).sun();
    return s.sunScale * radiance * solidAngleOf(SkyModel::halfSun());
}

Environment sunSkyPicture(const SunSky& s, const glm::dvec3& sunIrradiance) {
    const bool hasDisk = s.sunScale > 0 && s.halfAperture > 0;
    const uint32_t width = hasDisk ? kWidthWithSun : kWidthOfSky;
    const PictureAround around{width, width / 2};
    Environment environment;
    environment.width = around.width;
    environment.height = around.height;
    environment.radiance.assign(size_t(around.width) * around.height, glm::vec3(0));
    const SkyModel model(s.turbidity, s.albedo, std::asin(std::min(s.sun.z, 1.0)));
    if (s.skyScale > 0) addSky(s, model, around, environment.radiance);
    if (hasDisk) addSun(s, sunIrradiance, around, environment.radiance);
    return environment;
}

void addGround(Environment& picture, const glm::dvec3& albedo) {
    const PictureAround around{picture.width, picture.height};
    glm::dvec3 irradiance(0.0);
    const size_t horizon = size_t(picture.height / 2) * picture.width;
    for (size_t texel = 0; texel < horizon; ++texel) {
        const glm::dvec3 d =
            PictureAround::direction(around.turnOf(0.5), // its height is that of all
                                     around.downOf(0.5 + double(texel / picture.width)));
        irradiance += glm::dvec3(picture.radiance[texel]) * d.y * around.solidAngle(texel);
    }
    for (size_t texel = horizon; texel < picture.radiance.size(); ++texel)
        picture.radiance[texel] = glm::vec3(albedo * irradiance / glm::pi<double>());
}

} // namespace stromboli::sky
