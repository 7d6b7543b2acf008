// Pixels whose samples are dealt to strands, each of which a lane of its own may take up.
#include "host/bvh/wide_layout.hpp"
#include "host/kernel/kernel_tuning.hpp"
#include "host/render/kept_film.hpp"
#include "host/render/sampling_session.hpp"
#include "source_dir.h"
#include "tests/render/device_render.hpp"
#include "tests/render/film_checks.hpp"
#include "tests/support/device_fixture.hpp"

#include <gtest/gtest.h>

namespace stromboli {
namespace {

using namespace test;

constexpr uint32_t kWidth = 30, kHeight = 20;

class Strands : public DeviceTest {
  protected:
    Scene scene_ = loadScene(std::filesystem::path(STROMBOLI_SOURCE_DIR) / "scene" / "library" /
                             "cornell_mirror_glass.dae");
    GpuScene packed_ = packScene(scene_, buildWideBvh(scene_));

    /// Numbers of samples that are no multiples of any number of strands.
    static RenderSettings settings(uint32_t strands) {
        RenderSettings s;
        s.area = {kWidth, kHeight, {}};
        s.budget.mostSamplesPerPixel = 13;
        s.estimator.maxBounces = 4;
        s.strands = strands;
        return s;
    }
    VulkanBackend backend(const RenderSettings& s, const KernelTuning& tuning = {}) const {
        const Camera camera =
            makeCamera(scene_, CameraChoice::Automatic, s.area.width, s.area.height);
        return {testDevice(), packed_, camera, s, tuning};
    }
    Film filmOf(const RenderSettings& s, const KernelTuning& tuning = {}) const {
        VulkanBackend kernel = backend(s, tuning);
        return render(kernel, s);
    }
};

/// Sums differ, and samples do not: those of floats and what rounding took from them, to 2^-40 or
/// so, and less of the squares.
TEST_F(Strands, HaveTheSamplesOfOne) {
    const Film one = filmOf(settings(1));
    for (const uint32_t strands : {2u, 3u, 4u, 16u}) {
        const Film dealt = filmOf(settings(strands));
        for (size_t i = 0; i < one.pixels.size(); ++i) {
            const PixelStatistics &p = one.pixels[i], &q = dealt.pixels[i];
            ASSERT_EQ(p.taken(), q.taken());
            for (int c = 0; c < 3; ++c) {
                EXPECT_NEAR(p.mean[c], q.mean[c], 1e-11 * p.mean[c]) << strands;
                EXPECT_NEAR(p.m2[c], q.m2[c], 1e-6 * p.m2[c]) << strands;
            }
        }
    }
}

TEST_F(Strands, HaveTheSameBytesHoweverTheWorkIsCut) {
    const RenderSettings s = settings(4);
    const Film whole = filmOf(s);
    for (const KernelTuning& tuning :
         {KernelTuning{.lanes = 8}, KernelTuning{.lanes = 1000, .itemsPerDispatch = 63},
          KernelTuning{.fixedIterations = 7},
          KernelTuning{.scheduler = PathScheduler::Wavefront, .lanes = 100}})
        expectSameBytes(whole, filmOf(s, tuning));
}

/// A part of a picture is the picture's part: the number of strands that suits a device goes by the
/// whole.
TEST_F(Strands, OfAPartAreThoseOfTheWhole) {
    RenderSettings s = settings(4);
    const Film whole = filmOf(s);
    s.area.crop = {7, 5, 11, 9};
    s.strands = 0; // as many as suit a device with so many lanes
    VulkanBackend kernel = backend(s, {.lanesToFill = 4 * kWidth * kHeight});
    EXPECT_EQ(kernel.strands(), 4u);
    const Film part = render(kernel, s);
    for (uint32_t y = 0; y < 9; ++y)
        for (uint32_t x = 0; x < 11; ++x)
            EXPECT_TRUE(sameBytes(part.at(x, y), whole.at(x + 7, y + 5))) << x << ' ' << y;
}

/// Spread samples give pixels unequal targets, many of which add to some of the strands only.
TEST_F(Strands, HaveTheSamplesOfOneWhereTheyAreSpread) {
    RenderSettings s = settings(1);
    s.budget = {.mostSamplesPerPixel = kMostSamples, .meanSamplesPerPixel = 24};
    const Film one = filmOf(s);
    s.strands = 4;
    const Film dealt = filmOf(s);
    uint64_t samples = 0;
    for (const PixelStatistics& p : dealt.pixels)
        samples += p.taken();
    EXPECT_EQ(samples, 24u * kWidth * kHeight);
    // Rounding may give a sample to another pixel.
    size_t unequal = 0;
    for (size_t i = 0; i < one.pixels.size(); ++i) {
        const PixelStatistics &p = one.pixels[i], &q = dealt.pixels[i];
        if (p.taken() != q.taken())
            ++unequal;
        else
            EXPECT_NEAR(p.mean.x, q.mean.x, 1e-11 * p.mean.x) << i;
    }
    EXPECT_LT(unequal, one.pixels.size() / 50);
}

TEST_F(Strands, SamplesByThemselvesAreThoseOfOne) {
    VulkanBackend one = backend(settings(1)), dealt = backend(settings(4));
    const uint32_t pixel = kWidth * 9 + 14;
    const std::vector<SampleValue> some = dealt.samplesAlone(pixel, 3, 9);
    EXPECT_NE(some[0].radiance, some[1].radiance) << "the test could not see the wrong sample";
    for (uint32_t i = 0; i < 9; ++i) {
        const glm::dvec3 expected = one.sampleAlone(pixel, 3 + i).radiance;
        EXPECT_EQ(some[i].radiance, expected) << i;
        EXPECT_EQ(dealt.sampleAlone(pixel, 3 + i).radiance, expected) << i;
    }
}

/// A checkpoint goes on with its strands on another device, too.
TEST_F(Strands, OfASessionGoOnAsTheyWere) {
    const RenderSettings s = settings(4);
    VulkanBackend first = backend(s, {.lanes = 64, .fixedIterations = 5});
    SamplingSession begun(first, s);
    int reports = 3;
    while (begun.pass([&](const RenderProgress&) { return --reports > 0; })) {
    }
    const SessionState saved = sessionFromBytes(toBytes(begun.save()));
    EXPECT_EQ(saved.pixels.strands, 4u);
    EXPECT_EQ(saved.pixels.count(), kWidth * kHeight);
    EXPECT_EQ(differingPixels(begun.film(), stromboli::filmOf(saved)), 0u);

    VulkanBackend second = backend(s);
    SamplingSession goesOn(second, saved);
    while (goesOn.pass()) {
    }
    EXPECT_EQ(differingPixels(goesOn.film(), filmOf(s)), 0u);

    VulkanBackend other = backend(settings(2));
    EXPECT_THROW(SamplingSession(other, saved), std::invalid_argument);
}

/// A device with many lanes gives several to the pixels of a small picture, and one to those of a
/// large one; one that runs few lanes, one to all.
TEST(StrandsThatSuit, KeepALargeDeviceBusy) {
    DeviceTuning gpu;
    gpu.lanesToFill = 1u << 18;
    EXPECT_EQ(strandsThatSuit(gpu, 1920 * 1080), 1u);
    EXPECT_EQ(strandsThatSuit(gpu, (1u << 18) - 1), 1u);
    EXPECT_EQ(strandsThatSuit(gpu, 320 * 240), 2u);
    EXPECT_EQ(strandsThatSuit(gpu, 160 * 90), 16u);
    EXPECT_EQ(strandsThatSuit(gpu, 1), 16u);
    EXPECT_EQ(strandsThatSuit(DeviceTuning{}, 1), 1u);
}

TEST_F(Strands, AreSeveralOnGpusAlone) {
    const bool isCpu = testDevice().description().isCpu();
    EXPECT_EQ(backend(settings(0)).strands(), isCpu ? 1u : 16u);
}

} // namespace
} // namespace stromboli
