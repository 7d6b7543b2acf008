// The candidate that is a regression: what is linear in layers and place is kept, and pixels that
// show parts of two surfaces are told from their neighbours.
#include "host/denoise/denoiser.hpp"
#include "host/denoise/reference_regression.hpp"
#include "tests/denoise/pictures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>

namespace stromboli {
namespace {

using namespace test;

constexpr uint32_t kPatch = 40;

/// Radiance that is a linear function of the albedo's mean, the normal and the place.
Truth linear(uint32_t x, uint32_t y) {
    Truth t;
    const float gray = 0.2f + 0.6f * mixed(x, y, 0);
    t.albedo = {gray - 0.1f, gray, gray + 0.1f};
    t.normal = {mixed(x, y, 1), mixed(x, y, 2), mixed(x, y, 3)};
    t.radiance = glm::vec3(2 + 3 * gray + t.normal.x - 2 * t.normal.y + 0.5f * t.normal.z +
                           0.03f * float(x) - 0.02f * float(y));
    return t;
}

/// Without a difference of pilots all neighbours count. What is added to the products of features,
/// a 1e-5th, against their own of 0.01 and more (of places; squared deviations of the others are
/// 1 / 12 and 0.03), changes coefficients by a 1000th, so that the pixel changes by at most that
/// part of what the features explain, 7.
TEST(DenoiseRegression, KeepsWhatIsLinearInLayersAndPlace) {
    const denoise::NoisyPicture noisy = noisyPicture(kPatch, kPatch, linear, 1);
    const denoise::Prepared prepared = denoise::prepare(noisy);
    const std::vector<denoise::Pilot> alike(prepared.pixels.size());
    for (int y = 0; y < int(kPatch); ++y)
        for (int x = 0; x < int(kPatch); ++x) {
            const denoise::Candidate c = denoise::regressionAt(prepared, alike, x, y);
            const size_t i = size_t(y) * kPatch + size_t(x);
            const glm::dvec3 radiance = c.change * glm::dvec3(prepared.albedo[i]);
            for (int channel = 0; channel < 3; ++channel)
                EXPECT_NEAR(radiance[channel] / prepared.scale, 0, 7e-3);
        }
}

/// Columns beside each other of two surfaces, and between them one whose pixels show a part of
/// either, another part in each row.
TEST(DenoiseRegression, TakesNoiseOutOfPixelsThatShowTwoSurfaces) {
    constexpr uint32_t kEdge = kPatch / 2;
    const TruthOf truth = [](uint32_t x, uint32_t y) {
        const float part = x < kEdge ? 0.0f : x > kEdge ? 1.0f : mixed(x, y, 4);
        Truth t;
        t.sigma = 0.3f;
        t.albedo = glm::vec3(glm::mix(0.7f, 0.3f, part));
        t.normal = glm::mix(glm::vec3(0, 1, 0), glm::vec3(0, 0, 1), part);
        t.radiance = glm::vec3(glm::mix(2.0f, 0.3f, part));
        return t;
    };
    double before = 0, after = 0;
    for (uint32_t seed = 1; seed <= 8; ++seed) {
        const denoise::NoisyPicture noisy = noisyPicture(kPatch, kPatch, truth, seed);
        const denoise::DenoisedPicture denoised =
            denoise::denoisePicture(noisy, Denoiser::On, nullptr);
        for (uint32_t y = 0; y < kPatch; ++y) {
            const size_t i = size_t(y) * kPatch + kEdge;
            const double t = truth(kEdge, y).radiance.y;
            before += std::pow((noisy.mean[i].y - t) / t, 2);
            after += std::pow((denoised.mean[i].y - t) / t, 2);
        }
    }
    // A mean over pixels that are alike finds few here. Seven unknowns of some 25 pixels that
    // count fully leave at least a quarter.
    EXPECT_LT(after, 0.36 * before);
}

} // namespace
} // namespace stromboli
