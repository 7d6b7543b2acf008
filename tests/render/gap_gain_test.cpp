// What the gap proposal is for: less noise where a light hangs close below a ceiling.
#include "host/render/sampling_session.hpp"
#include "source_dir.h"
#include "tests/render/device_render.hpp"
#include "tests/support/device_fixture.hpp"

#include <gtest/gtest.h>

namespace stromboli {
namespace {

using namespace test;

class GapGain : public DeviceTest {
  protected:
    /// From the pixels' spread over several seeds.
    static Expense expense(bool gapProposal) {
        constexpr uint32_t kSeeds = 8;
        const Scene scene = loadScene(std::filesystem::path(STROMBOLI_SOURCE_DIR) /
                                      "scene/library/cornell_boxes.dae");
        const GpuScene gpu = packScene(scene, buildWideBvh(scene));
        RenderSettings s;
        s.area.width = 64, s.area.height = 48;
        s.budget.mostSamplesPerPixel = 32;
        s.estimator.maxBounces = 5;
        s.estimator.gapProposal = gapProposal;
        const Camera camera =
            makeCamera(scene, CameraChoice::Automatic, s.area.width, s.area.height);
        Expense e;
        Film over(s.area.width, s.area.height); // statistics of the pixels' means over seeds
        VulkanBackend backend(testDevice(), gpu, camera, s); // compiled once for all seeds
        for (s.estimator.seed = 0; s.estimator.seed < kSeeds; ++s.estimator.seed) {
            backend.setPicture(camera, s);
            const Film film = render(backend, s);
            for (size_t i = 0; i < film.pixels.size(); ++i)
                over.pixels[i].add(film.pixels[i].mean);
            e.rays += double(backend.counters().rays);
        }
        glm::dvec3 mean(0.0);
        for (const PixelStatistics& p : over.pixels)
            mean += p.mean / double(over.pixels.size());
        for (const PixelStatistics& p : over.pixels) {
            const glm::dvec3 v = p.variance() / (p.mean * p.mean + 0.01 * mean * mean);
            e.variance += (v.x + v.y + v.z) / 3 / double(over.pixels.size());
        }
        return e;
    }
};

TEST_F(GapGain, LessNoiseForNoMoreRays) {
    const Expense mixed = expense(true), plain = expense(false);
    EXPECT_LT(mixed.variance, 0.85 * plain.variance); // by hand at 240 x 180: 0.70
    EXPECT_LT(mixed.rays, 1.01 * plain.rays);
}

} // namespace
} // namespace stromboli
