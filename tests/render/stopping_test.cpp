// What is in a pixel when a render is stopped in the middle of a pass. Paths take unequal time, and
// long ones are often the bright ones: which of the samples under way are ended decides whether the
// pixels of a stopped render are right on the mean. Dropping all of them favours short paths,
// ending all of them long ones (docs/theory/noise.md, "A render that is stopped").
#include "tests/render/device_render.hpp"
#include "tests/support/device_fixture.hpp"

#include "host/bvh/wide_layout.hpp"
#include "host/render/sampling_session.hpp"
#include "scene/generate/scene_maker.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli {
namespace {

using namespace test;
using namespace scenes;

constexpr uint32_t kSide = 128, kSeeds = 8;

/// A sphere that emits 1 and reflects 3/4, seen from inside, where every hit ends the path with
/// probability 1/4: a sample is the number of its hits, whose mean is 4.
class Stopping : public DeviceTest {
  protected:
    uint32_t strands_ = 1;
    Scene scene_ = [] {
        SceneMaker b;
        b.sphere({0, 0, 0}, 1, b.add(diffuse(0.75f, 1)));
        return b.scene;
    }();
    GpuScene packed_ =
        packScene(scene_, buildWideBvh(scene_), lightSelection(settings(0).estimator));
    Camera camera_ = lookingAt({0.1, 0.2, 0.3}, {0.7, -0.4, 0.1}, 1.0);

    RenderSettings settings(uint32_t seed) const {
        RenderSettings s;
        s.strands = strands_;
        s.area.width = s.area.height = kSide;
        s.estimator.maxBounces = 1000;
        s.estimator.directLight = DirectLight::Bsdf;
        s.estimator.sampler = Sampler::Independent;
        s.estimator.roulette = {Roulette::Mode::Fixed, 0.25};
        s.estimator.seed = seed;
        return s;
    }

    static std::vector<PixelTarget> allPixels(uint32_t samples) {
        std::vector<PixelTarget> targets;
        for (uint32_t i = 0; i < kSide * kSide; ++i)
            targets.push_back({i, samples});
        return targets;
    }

    /// Whether the samples of the first pass are a block of their own.
    enum class First { InTheSameBlock, InAnother };

    /// A pass to `before` samples a pixel, then one that is stopped after a dispatch.
    Film stopped(VulkanBackend& backend, uint32_t seed, uint32_t before, First first) {
        backend.setPicture(camera_, settings(seed));
        Film film(kSide, kSide);
        if (before > 0) backend.sample(allPixels(before), film, {});
        Film earlier(kSide, kSide);
        if (first == First::InAnother) {
            std::swap(film, earlier);
            backend.beginAt(before);
        }
        const uint64_t pathsBefore = backend.counters().paths;
        uint64_t reported = 0;
        backend.sample(allPixels(10000), film, [&](uint64_t done) {
            reported = done;
            return false;
        });
        uint64_t taken = 0;
        for (const PixelStatistics& p : film.pixels)
            taken += p.taken();
        if (first == First::InAnother) {
            EXPECT_EQ(reported, taken);
            for (size_t i = 0; i < film.pixels.size(); ++i)
                film.pixels[i].merge(earlier.pixels[i]);
        } else {
            EXPECT_EQ(reported, taken - uint64_t(before) * film.pixels.size());
        }
        EXPECT_EQ(backend.counters().paths - pathsBefore, reported);
        return film;
    }

    /// The pixels of stopped renders are 4 on the mean, within 4.5 standard errors (false alarm
    /// below 1e-5) of a tenth of a percent, which is also an upper bound of what remains of the
    /// bias in the second order of 1 / samples.
    void expectUnbiased(uint32_t before, uint32_t iterations, double samplesLeast,
                        double samplesMost, First first = First::InTheSameBlock) {
        PixelStatistics means;
        double samples = 0;
        // Dispatches of so many loop iterations, with a lane for each strand of each pixel.
        VulkanBackend backend(testDevice(), packed_, camera_, settings(0),
                              {.lanes = strands_ * kSide * kSide, .fixedIterations = iterations});
        for (uint32_t seed = 1; seed <= kSeeds; ++seed)
            for (const PixelStatistics& p : stopped(backend, seed, before, first).pixels) {
                ASSERT_GT(p.taken(), 0u) << "a pixel that was begun has no sample";
                means.add(p.mean);
                samples += p.taken() - before;
            }
        samples /= double(means.count);
        EXPECT_GT(samples, samplesLeast);
        EXPECT_LT(samples, samplesMost);
        const double error = std::sqrt(means.varianceOfMean().x);
        EXPECT_LT(error, 0.0025 * 4) << "the test could not see one and a half percent";
        // What strands leave of the bias: the covariance of a sample's value and time over the mean
        // time, 12 / 4, over the samples of a strand and those of the pixel.
        const double leftByStrands = strands_ > 1 ? 3.0 * strands_ / (samples * samples) : 0.0;
        EXPECT_NEAR(means.mean.x, 4, 4.5 * error + 0.001 * 4 + leftByStrands)
            << samples << " samples after " << before << ", standard error " << error;
    }
};

TEST_F(Stopping, AboutFiveSamplesOfAnEmptyFilm) {
    expectUnbiased(0, 20, 4, 6.5);
}

TEST_F(Stopping, FewerThanOneSample) {
    expectUnbiased(0, 4, 0.9, 2);
}

TEST_F(Stopping, AboutFiveSamplesOnTopOfAsMany) {
    expectUnbiased(5, 20, 4, 6.5);
}

TEST_F(Stopping, FewSamplesOnTopOfMany) {
    expectUnbiased(16, 8, 1, 3);
}

/// What was sampled before is not in the kernel's sums any more, but counts as it did.
TEST_F(Stopping, AboutFiveSamplesOnTopOfAnEarlierBlock) {
    expectUnbiased(5, 20, 4, 6.5, First::InAnother);
}

TEST_F(Stopping, FewSamplesOnTopOfAnEarlierBlock) {
    expectUnbiased(16, 8, 1, 3, First::InAnother);
}

/// Each strand of a pixel has a sample under way, and what is ended of one counts beside the
/// others: dropping all would be wrong by -12 %, ending all by 3 %.
TEST_F(Stopping, AboutFiveSamplesOfEachOfFourStrands) {
    strands_ = 4;
    expectUnbiased(0, 20, 4 * 4, 4 * 6.5);
}

TEST_F(Stopping, AboutFiveSamplesOfEachStrandOnTopOfAsMany) {
    strands_ = 4;
    expectUnbiased(20, 20, 4 * 4, 4 * 6.5);
}

TEST_F(Stopping, AboutFiveSamplesOfEachStrandOnTopOfAnEarlierBlock) {
    strands_ = 4;
    expectUnbiased(20, 20, 4 * 4, 4 * 6.5, First::InAnother);
}

/// Nothing of the stopped pass is left in the lanes' hands: the next one goes on with whole
/// samples.
TEST_F(Stopping, TheNextPassGoesOnAsIfNothingHadHappened) {
    const RenderSettings s = settings(1);
    const auto filmAfter = [&](std::vector<int> dispatches) {
        VulkanBackend backend(testDevice(), packed_, camera_, s,
                              {.lanes = 1000, .itemsPerDispatch = 4096, .fixedIterations = 30});
        Film film(kSide, kSide);
        for (int count : dispatches)
            backend.sample(allPixels(12), film, [&](uint64_t) { return --count > 0; });
        backend.sample(allPixels(12), film, {});
        return film;
    };
    const Film once = filmAfter({}), cut = filmAfter({3, 1, 10, 2});
    for (size_t i = 0; i < once.pixels.size(); ++i) {
        ASSERT_EQ(cut.pixels[i].taken(), 12u);
        ASSERT_EQ(cut.pixels[i].mean, once.pixels[i].mean) << i;
        ASSERT_EQ(cut.pixels[i].m2, once.pixels[i].m2) << i;
    }
}

} // namespace
} // namespace stromboli
