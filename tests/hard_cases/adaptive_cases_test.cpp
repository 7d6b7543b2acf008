// Hard case 57 on the device; accumulation_cases_test.cpp has the rule itself.
#include "host/render/sampling_plan.hpp"
#include "host/stress/scenes.hpp"
#include "tests/hard_cases/hits.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace stromboli::test {
namespace {

TEST_F(HardCases, C57_SamplesInTheFilmAreThoseTraced) {
    stress::DeviceSubject device(testDevice());
    RenderSettings s = stress::picture(32, 500, 0); // a sample is a ray
    s.budget.adaptive = {.enabled = true, .batch = 32, .tolerance = 0.05};
    scenes::SceneMaker m; // half of the picture lit, its edge noisy
    m.quad({0, -1, 0}, {1, 0.1f, 0}, {0.1f, 2, 0}, m.add(scenes::emissive(1, true)));
    const stress::Picture p =
        device.render(m.scene, lookingAt({0, 0, 1}, {0, 0, 0}, 0.9), s, {}, {});
    uint64_t samples = 0;
    uint32_t least = s.budget.mostSamplesPerPixel, most = 0;
    for (const PixelStatistics& pixel : p.film.pixels) {
        samples += pixel.taken();
        least = std::min(least, pixel.taken()), most = std::max(most, pixel.taken());
    }
    EXPECT_EQ(samples, p.rays);
    EXPECT_EQ(least, SamplingPlan::kMinimumSamples);
    EXPECT_GT(most, least);
    EXPECT_LE(most, s.budget.mostSamplesPerPixel);
}

} // namespace
} // namespace stromboli::test
