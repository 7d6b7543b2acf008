// What adaptive sampling does to the mean, measured over seeds against a long uniform render.
#include "host/render/render.hpp"
#include "tests/render/device_render.hpp"
#include "tests/support/device_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli {
namespace {

using namespace test;

constexpr uint32_t kSeeds = 32;

RenderSettings baseSettings() {
    RenderSettings s;
    s.width = 32, s.height = 24;
    s.samplesPerPixel = 1024;
    s.maxBounces = 3;
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
                       uint32_t firstSeed, uint32_t seeds = kSeeds) {
    const Camera camera = makeCamera(scene, CameraChoice::Automatic, s.width, s.height, s.cs184);
    double sum = 0, squares = 0;
    MeanAndError result;
    std::vector<double> means;
    for (uint32_t i = 0; i < seeds; ++i) {
        s.seed = firstSeed + i;
        const Film film = renderOnDevice(device, scene, camera, s);
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

class AdaptiveBias : public DeviceTest {
  protected:
    Scene scene =
        loadScene(std::filesystem::path(STROMBOLI_SOURCE_DIR) / "scene/library/light_area.dae");
};

TEST_F(AdaptiveBias, DefaultRuleIsBelowHalfAPercent) {
    RenderSettings s = baseSettings();
    const MeanAndError uniform = overSeeds(testDevice(), scene, s, 1000);
    s.adaptive = {true, 32, 0.1};
    const MeanAndError adaptive = overSeeds(testDevice(), scene, s, 0);
    const double bias = (adaptive.mean - uniform.mean) / uniform.mean;
    const double sigma = std::hypot(adaptive.error, uniform.error) / uniform.mean;
    std::printf("bias %+.4f %% (standard error %.4f %%), %.1f %% of the samples\n", 100 * bias,
                100 * sigma, 100.0 * double(adaptive.samples) / double(uniform.samples));
    EXPECT_LT(adaptive.samples, uniform.samples); // else nothing was adaptive
    EXPECT_LT(std::abs(bias), 0.005 + 4 * sigma);
    EXPECT_LT(sigma, 0.004); // else the test proves nothing
}

TEST_F(AdaptiveBias, StoppingAtAStatedNoiseIsBelowATenthOfAPercent) {
    RenderSettings s = baseSettings();
    s.samplesPerPixel = 128;
    const MeanAndError uniform = overSeeds(testDevice(), scene, s, 1000, 2 * kSeeds);
    s.samplesPerPixel = 1u << 16;
    s.stop.noise = 0.06;
    const MeanAndError stopped = overSeeds(testDevice(), scene, s, 0, 2 * kSeeds);
    const double bias = (stopped.mean - uniform.mean) / uniform.mean;
    const double sigma = std::hypot(stopped.error, uniform.error) / uniform.mean;
    std::printf("bias %+.4f %% (standard error %.4f %%), %.1f samples a pixel\n", 100 * bias,
                100 * sigma, double(stopped.samples) / (2 * kSeeds * s.width * s.height));
    EXPECT_LT(std::abs(bias), 0.001 + 3 * sigma);
    EXPECT_LT(sigma, 0.0005); // else the test proves nothing
}

TEST_F(AdaptiveBias, RareLightIsNeverLost) {
    // A lamp so small that bounces meet it about once in 200 samples: the published rule stops
    // most pixels black.
    RenderSettings s = baseSettings();
    s.directLight = DirectLight::Bsdf;
    s.maxBounces = 1;
    s.samplesPerPixel = 2048;
    const Camera camera = makeCamera(scene, CameraChoice::Automatic, s.width, s.height, false);
    const Film uniform = renderOnDevice(testDevice(), scene, camera, s);
    s.adaptive = {true, 32, 0.05};
    s.seed = 7;
    const Film adaptive = renderOnDevice(testDevice(), scene, camera, s);
    size_t lost = 0;
    for (size_t i = 0; i < uniform.pixels.size(); ++i)
        if (uniform.pixels[i].mean.y > 0.05 && adaptive.pixels[i].mean.y == 0) ++lost;
    EXPECT_EQ(lost, 0u);
}

TEST_F(AdaptiveBias, RouletteLeavesTheMeanUnchanged) {
    RenderSettings s = baseSettings();
    s.samplesPerPixel = 256;
    s.maxBounces = 12;
    s.roulette.mode = Roulette::Mode::None;
    const MeanAndError none = overSeeds(testDevice(), scene, s, 0);
    s.roulette.mode = Roulette::Mode::Throughput;
    const MeanAndError throughput = overSeeds(testDevice(), scene, s, 100);
    s.roulette = {Roulette::Mode::Fixed, 0.3};
    const MeanAndError fixed = overSeeds(testDevice(), scene, s, 200);
    // 4.5 sigma: one false alarm in 150,000.
    EXPECT_LT(std::abs(throughput.mean - none.mean),
              4.5 * std::hypot(throughput.error, none.error));
    EXPECT_LT(std::abs(fixed.mean - none.mean), 4.5 * std::hypot(fixed.error, none.error));
}

} // namespace
} // namespace stromboli
