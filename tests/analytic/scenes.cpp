#include "tests/analytic/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli::test {

void addFloor(SceneMaker& builder, uint32_t material) {
    builder.quad({-10, 0, -10}, {0, 0, 20}, {20, 0, 0}, material);
}

Scene sphereInAmbientLight(const Material& material) {
    SceneMaker b;
    b.sphere({0, 0, 0}, 1, b.add(material));
    b.add(ambient(1));
    return b.scene;
}

Light pointLight(float intensity, const glm::vec3& position) {
    Light light;
    light.position = position;
    light.color = glm::vec3(intensity);
    return light;
}

RenderSettings smallPicture(uint32_t samplesPerPixel, uint32_t maxBounces) {
    RenderSettings settings;
    settings.area.width = settings.area.height = 16;
    settings.budget.mostSamplesPerPixel = samplesPerPixel;
    settings.estimator.maxBounces = maxBounces;
    settings.estimator.roulette.mode = Roulette::Mode::None;
    return settings;
}

Estimate estimate(const Scene& scene, const Camera& camera, const RenderSettings& settings) {
    PixelStatistics all;
    for (const PixelStatistics& pixel : renderFilm(scene, camera, settings).pixels)
        all.merge(pixel);
    EXPECT_EQ(all.rejected, 0u);
    return {all.mean, glm::sqrt(all.varianceOfMean())};
}

void expectMean(const Estimate& found, const glm::dvec3& expected) {
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found.mean[c], expected[c],
                    4.5 * found.error[c] + kRounding * std::abs(expected[c]))
            << "channel " << c << ", standard error " << found.error[c];
}

void expectMean(const Estimate& found, double expected) {
    expectMean(found, glm::dvec3(expected));
}

void expectSameMean(const Estimate& a, const Estimate& b) {
    expectMean({a.mean, glm::sqrt(a.error * a.error + b.error * b.error)}, b.mean);
}

} // namespace stromboli::test
