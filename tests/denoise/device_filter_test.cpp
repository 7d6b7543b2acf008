// The shaders: the reference's numbers, and the same bytes however the work is cut.
#include "host/denoise/device_filter.hpp"
#include "host/denoise/reference_filter.hpp"
#include "host/denoise/taps.hpp"
#include "tests/denoise/pictures.hpp"
#include "tests/support/device_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

namespace stromboli {
namespace {

using namespace test;
using denoise::DeviceFilter;
using denoise::Prepared;

constexpr uint32_t kWidth = 83, kHeight = 101; // no multiples of a workgroup

/// Some pixels are unknown, two of them beside each other.
Prepared picture(float sigma, uint32_t seed) {
    denoise::NoisyPicture noisy = noisyPicture(
        kWidth, kHeight, [sigma](uint32_t x, uint32_t y) { return room(x, y, sigma); }, seed);
    for (const uint32_t i : {0u, 700u, 701u, 4000u, kWidth * kHeight - 1})
        noisy.mean[i].x = std::numeric_limits<float>::quiet_NaN();
    Prepared prepared = denoise::prepare(noisy);
    denoise::limitOutliers(prepared);
    return prepared;
}

class DenoiseDevice : public DeviceTest {
  protected:
    std::vector<gpu::DenoiseResult> filtered(const Prepared& p,
                                             const denoise::FilterTuning& tuning = {}) {
        return DeviceFilter(testDevice(), tuning).run(p);
    }
};

void expectSameBytes(const std::vector<gpu::DenoiseResult>& a,
                     const std::vector<gpu::DenoiseResult>& b) {
    ASSERT_EQ(a.size(), b.size());
    EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof a[0]), 0);
}

/// Floats lose seven digits where many are added up, and shares are quotients of differences.
TEST_F(DenoiseDevice, ComputesWhatTheReferenceDoes) {
    for (const float sigma : {0.0f, 0.02f, 0.3f}) {
        const Prepared p = picture(sigma, 1);
        const std::vector<gpu::DenoiseResult> device = filtered(p);
        const std::vector<denoise::ReferenceResult> reference = denoise::filterOnHost(p);
        double largest = 0;
        for (size_t i = 0; i < device.size(); ++i) {
            const glm::dvec3 mean = device[i].mean;
            for (int c = 0; c < 3; ++c)
                largest = std::max(largest, std::abs(mean[c] - reference[i].mean[c]) /
                                                std::max(reference[i].mean[c], 0.1));
            const auto expectClose = [&](double value, double expected) {
                EXPECT_NEAR(value, expected, 1e-3 * (sigma * sigma + std::abs(expected)) + 1e-9);
            };
            expectClose(device[i].ownNoise, reference[i].own.x);
            expectClose(device[i].ownChange, reference[i].own.y);
            expectClose(device[i].windowNoise, reference[i].window.x);
            expectClose(device[i].windowChange, reference[i].window.y);
            expectClose(device[i].ownVariance, reference[i].ownVariance);
        }
        EXPECT_LT(largest, 1e-4) << sigma;
    }
}

TEST_F(DenoiseDevice, TheSameBytesTwice) {
    const Prepared p = picture(0.2f, 2);
    expectSameBytes(filtered(p), filtered(p));
}

/// Whoever may want it no longer is asked between short dispatches; none of it changes a byte.
TEST_F(DenoiseDevice, MayBeGivenUp) {
    const Prepared p = picture(0.2f, 5);
    DeviceFilter filter(testDevice());
    int questions = 0;
    expectSameBytes(filtered(p), filter.run(p, [&] { return ++questions < 0; }));
    EXPECT_GE(questions, 10); // two parts of each of five passes
    for (const int last : {1, questions}) {
        int asked = 0;
        EXPECT_TRUE(filter.run(p, [&] { return ++asked == last; }).empty());
        EXPECT_EQ(asked, last);
    }
}

TEST_F(DenoiseDevice, TheSameBytesInStripsOfAnyHeight) {
    const Prepared p = picture(0.2f, 3);
    const std::vector<gpu::DenoiseResult> whole = filtered(p);
    for (const uint32_t rows : {1u, 7u, 64u, 100u}) // and the rows around that each needs
        expectSameBytes(whole, filtered(p, {.pixelsAtOnce = (rows + 2 * denoise::kHalo) * kWidth}));
}

TEST_F(DenoiseDevice, TheSameBytesHoweverRowsAreRead) {
    const Prepared p = picture(0.2f, 4);
    expectSameBytes(filtered(p, {.texelFetch = true}), filtered(p, {.texelFetch = false}));
}

} // namespace
} // namespace stromboli
