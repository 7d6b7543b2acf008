// What adaptive sampling does to the mean, measured over seeds against a long uniform render.
#include "host/bvh/wide_layout.hpp"
#include "host/render/sampling_session.hpp"
#include "source_dir.h"
#include "tests/render/device_render.hpp"
#include "tests/support/device_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli {
namespace {

using namespace test;

constexpr uint32_t kBiasSeeds = 32;
/// For a bound that is far beyond the noise of these.
constexpr uint32_t kFewSeeds = 8;

RenderSettings baseSettings() {
    RenderSettings s;
    s.area.width = 32, s.area.height = 24;
    s.budget.mostSamplesPerPixel = 1024;
    s.estimator.maxBounces = 3;
    return s;
}

double meanOf(const Film& film) {
    double sum = 0;
    for (const PixelStatistics& p : film.pixels)
        sum += (p.mean.x + p.mean.y + p.mean.z) / 3;
    return sum / double(film.pixels.size());
}

struct MeanAndError {
    double mean = 0, error = 0;
    uint64_t samples = 0;
};

/// The picture's mean over seeds, with its standard error from their spread.
MeanAndError overSeeds(const vulkan::Device& device, const Scene& scene, RenderSettings s,
                       uint32_t firstSeed, uint32_t seeds = kBiasSeeds) {
    const Camera camera = makeCamera(scene, CameraChoice::Automatic, s.area.width, s.area.height);
    double sum = 0, squares = 0;
    MeanAndError result;
    std::vector<double> means;
    const GpuScene gpu = packScene(scene, buildWideBvh(scene), lightSelection(s.estimator));
    VulkanBackend backend(device, gpu, camera, s); // compiled once for all seeds
    for (uint32_t i = 0; i < seeds; ++i) {
        s.estimator.seed = firstSeed + i;
        backend.setPicture(camera, s);
        const Film film = stromboli::render(backend, s);
        means.push_back(meanOf(film));
        for (const PixelStatistics& p : film.pixels)
            result.samples += p.taken();
    }
    for (double m : means)
        sum += m;
    result.mean = sum / seeds;
    for (double m : means)
        squares += (m - result.mean) * (m - result.mean);
    result.error = std::sqrt(squares / (seeds - 1) / seeds);
    return result;
}

/// A relative difference of two means and its standard error.
struct Bias {
    double value = 0, error = 0;

    Bias(const MeanAndError& found, const MeanAndError& expected)
        : value((found.mean - expected.mean) / expected.mean),
          error(std::hypot(found.error, expected.error) / expected.mean) {}

    /// Shows the true bias to be below `bound`: were it as large, so many standard errors would
    /// hide it in one of 1300 measurements at most. The error is itself from the seeds' spread, so
    /// that the number is Student's t: 3.5 with 30 degrees of freedom, 5.1 with the 7 of few seeds.
    bool isShownToBeBelow(double bound, double errors = 3.5) const {
        return std::abs(value) + errors * error < bound;
    }

    /// This measurement, had the bias been larger by `more`, whichever way it is.
    Bias with(double more) const {
        Bias b = *this;
        b.value += b.value < 0 ? -more : more;
        return b;
    }
};

class AdaptiveBias : public DeviceTest {
  protected:
    Scene scene =
        loadScene(std::filesystem::path(STROMBOLI_SOURCE_DIR) / "scene/library/light_area.dae");
};

TEST_F(AdaptiveBias, DefaultRuleIsBelowHalfAPercent) {
    RenderSettings s = baseSettings();
    const MeanAndError uniform = overSeeds(testDevice(), scene, s, 1000, kFewSeeds);
    s.budget.adaptive = {.enabled = true, .batch = 32, .tolerance = 0.1};
    const MeanAndError adaptive = overSeeds(testDevice(), scene, s, 0, kFewSeeds);
    const Bias bias(adaptive, uniform);
    std::printf("bias %+.4f %% (standard error %.4f %%), %.1f %% of the samples\n",
                100 * bias.value, 100 * bias.error,
                100.0 * double(adaptive.samples) / double(uniform.samples));
    EXPECT_LT(adaptive.samples, uniform.samples); // else nothing was adaptive
    constexpr double kErrors = 5.1;
    EXPECT_TRUE(bias.isShownToBeBelow(0.005, kErrors));
    EXPECT_FALSE(bias.with(0.005).isShownToBeBelow(0.005, kErrors)) << "the test cannot fail";
}

TEST_F(AdaptiveBias, StoppingAtAStatedNoiseIsBelowAQuarterOfAPercent) {
    RenderSettings s = baseSettings();
    s.budget.mostSamplesPerPixel = 128;
    const MeanAndError uniform = overSeeds(testDevice(), scene, s, 1000, 2 * kBiasSeeds);
    s.budget.mostSamplesPerPixel = 1u << 16;
    s.budget.stop.noise = 0.08;
    const MeanAndError stopped = overSeeds(testDevice(), scene, s, 0, 2 * kBiasSeeds);
    const Bias bias(stopped, uniform);
    std::printf("bias %+.4f %% (standard error %.4f %%), %.1f samples a pixel\n", 100 * bias.value,
                100 * bias.error,
                double(stopped.samples) / (2 * kBiasSeeds * s.area.width * s.area.height));
    EXPECT_TRUE(bias.isShownToBeBelow(0.0025));
    EXPECT_FALSE(bias.with(0.0025).isShownToBeBelow(0.0025)) << "the test cannot fail";
}

TEST_F(AdaptiveBias, RareLightIsNeverLost) {
    // An emitter so small that bounces meet it about once in 200 samples: the published rule stops
    // most pixels black.
    RenderSettings s = baseSettings();
    s.estimator.directLight = DirectLight::Bsdf;
    s.estimator.maxBounces = 1;
    s.budget.mostSamplesPerPixel = 2048;
    const Camera camera = makeCamera(scene, CameraChoice::Automatic, s.area.width, s.area.height);
    const Film uniform = renderOnDevice(testDevice(), scene, camera, s);
    s.budget.adaptive = {.enabled = true, .batch = 32, .tolerance = 0.05};
    s.estimator.seed = 7;
    const Film adaptive = renderOnDevice(testDevice(), scene, camera, s);
    size_t lost = 0;
    for (size_t i = 0; i < uniform.pixels.size(); ++i)
        if (uniform.pixels[i].mean.y > 0.05 && adaptive.pixels[i].mean.y == 0) ++lost;
    EXPECT_EQ(lost, 0u);
}

TEST_F(AdaptiveBias, RouletteLeavesTheMeanUnchanged) {
    RenderSettings s = baseSettings();
    s.budget.mostSamplesPerPixel = 256;
    s.estimator.maxBounces = 12;
    s.estimator.roulette.mode = Roulette::Mode::None;
    const MeanAndError none = overSeeds(testDevice(), scene, s, 0);
    s.estimator.roulette.mode = Roulette::Mode::Throughput;
    const MeanAndError throughput = overSeeds(testDevice(), scene, s, 100);
    s.estimator.roulette = {Roulette::Mode::Fixed, 0.3};
    const MeanAndError fixed = overSeeds(testDevice(), scene, s, 200);
    // 4.5 sigma: one false alarm in 150,000.
    EXPECT_LT(std::abs(throughput.mean - none.mean),
              4.5 * std::hypot(throughput.error, none.error));
    EXPECT_LT(std::abs(fixed.mean - none.mean), 4.5 * std::hypot(fixed.error, none.error));
}

} // namespace
} // namespace stromboli
