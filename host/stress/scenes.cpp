#include "host/stress/scenes.hpp"

#include <cmath>

namespace stromboli::stress {

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

} // namespace stromboli::stress
