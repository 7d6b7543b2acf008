#include "host/stress/scenes.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stromboli::stress {

// --- Scenes --------------------------------------------------------------------------------------

std::vector<float> sizes(const Run& run) {
    if (run.quick()) return {1e-6f, 1e6f};
    return {1e-6f, 1e-4f, 1e-2f, 1, 1e2f, 1e4f, 1e6f};
}

Scene placed(Scene scene, float factor, const glm::vec3& by) {
    for (glm::vec3& p : scene.positions)
        p = factor * p + by;
    for (Sphere& s : scene.spheres) {
        s.center = factor * s.center + by;
        s.radius *= factor;
    }
    return scene;
}

Camera placed(Camera camera, double factor, const glm::dvec3& by) {
    camera.position = factor * camera.position + by;
    return camera;
}

Scene turned(Scene scene) {
    // Orthonormal, since 2^2 + 3^2 + 6^2 = 7^2.
    const glm::dmat3 turn(glm::dvec3(2, 3, 6) / 7.0, glm::dvec3(3, -6, 2) / 7.0,
                          glm::dvec3(6, 2, -3) / 7.0);
    for (glm::vec3& p : scene.positions)
        p = glm::vec3(turn * glm::dvec3(p));
    for (Sphere& s : scene.spheres)
        s.center = glm::vec3(turn * glm::dvec3(s.center));
    return scene;
}

RenderSettings picture(uint32_t side, uint32_t samplesPerPixel, uint32_t maxBounces) {
    RenderSettings settings;
    settings.area.width = settings.area.height = side;
    settings.budget.mostSamplesPerPixel = samplesPerPixel;
    settings.estimator.maxBounces = maxBounces;
    settings.estimator.roulette.mode = Roulette::Mode::None;
    settings.estimator.sampler =
        Sampler::Independent; // z-tests know the error of independent samples
    return settings;
}

// --- Totals of pictures --------------------------------------------------------------------------

namespace {

double sigmas(const glm::dvec3& difference, const glm::dvec3& expected, const glm::dvec3& error) {
    double worst = 0;
    for (int c = 0; c < 3; ++c) {
        const double excess = std::abs(difference[c]) - kRounding * std::abs(expected[c]);
        if (excess <= 0) continue;
        if (!(error[c] > 0)) return std::numeric_limits<double>::infinity(); // NaN, too
        worst = std::max(worst, excess / error[c]);
    }
    return worst;
}

} // namespace

Totals::Totals(const Film& film) {
    for (const PixelStatistics& p : film.pixels)
        all.merge(p);
}

PixelStatistics columnOf(const Film& film, uint32_t x) {
    PixelStatistics all;
    for (uint32_t y = 0; y < film.height; ++y)
        all.merge(film.at(x, y));
    return all;
}

double Totals::sum() const {
    return std::max({all.mean.x, all.mean.y, all.mean.z}) * all.count;
}

double sigmasOff(const Totals& found, const glm::dvec3& expected) {
    return sigmas(found.all.mean - expected, expected, found.error());
}

double sigmasOff(const Totals& found, const Totals& other) {
    const glm::dvec3 a = found.error(), b = other.error();
    return sigmas(found.all.mean - other.all.mean, other.all.mean, glm::sqrt(a * a + b * b));
}

// --- Lookups as pictures -------------------------------------------------------------------------

std::vector<glm::dvec3> lookUpInPicture(Run& run, const Scene& textures,
                                        const std::vector<Lookup>& lookups) {
    SceneMaker m;
    m.scene.images = textures.images;
    m.scene.textures = textures.textures;
    for (uint32_t i = 0; i < textures.textures.size(); ++i) {
        Material lamp = emissive(1);
        lamp.textures = {{.slot = TextureSlot::Emission, .texture = i}};
        m.add(lamp);
    }
    // A multiple of 8, as in other cases: pictures of odd sizes are case 65.
    const uint32_t side = (uint32_t(std::ceil(std::sqrt(double(lookups.size())))) + 7) / 8 * 8;
    for (uint32_t i = 0; i < lookups.size(); ++i) {
        m.quad({float(i % side), float(i / side), 0}, {1, 0, 0}, {0, 1, 0}, lookups[i].texture);
        const auto first = uint32_t(m.scene.attributes.size());
        VertexAttributes& corner = m.scene.attributes.emplace_back();
        corner.uv[0] = lookups[i].uv;
        m.scene.attributeCorners.insert(m.scene.attributeCorners.end(), 2, {first, first, first});
    }
    const double middle = 0.5 * side;
    Camera camera = lookingAt({middle, middle, 1}, {middle, middle, 0}, middle);
    camera.orthographic = true;
    const Film film = run.render(m.scene, camera, picture(side, 1, 0)).film;
    std::vector<glm::dvec3> found;
    for (uint32_t i = 0; i < lookups.size(); ++i) { // row 0 of a picture is at the top
        const PixelStatistics& p = film.at(i % side, side - 1 - i / side);
        found.push_back(p.count > 0 ? p.mean
                                    : glm::dvec3(std::numeric_limits<double>::quiet_NaN()));
    }
    return found;
}

} // namespace stromboli::stress
