// addSample of accumulate.glsl: ten million samples, cancellation, and samples to be rejected.
#include "tests/shaders/queries.h"
#include "tests/support/device_fixture.hpp"
#include "tests/support/test_shader.hpp"

#include "embedded/accumulate_shader.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

namespace stromboli::test {
namespace {

using gpu::AccumulateAnswer;
using gpu::AccumulateQuery;
using gpu::PixelState;

/// llvmpipe silently ends all loops of a group after 65,535 passes.
constexpr uint32_t kMostPerDispatch = 60000;
constexpr uint32_t kNever = 0xFFFFFFFF;

AccumulateQuery pixel(const glm::vec3& even, const glm::vec3& odd) {
    AccumulateQuery q{};
    q.state.firstRejected = kNever;
    q.even = even;
    q.odd = odd;
    q.injectAt = kNever;
    return q;
}

bool sameBits(const PixelState& a, const PixelState& b) {
    return std::memcmp(&a, &b, sizeof(PixelState)) == 0;
}

glm::dvec3 mean(const PixelState& s) {
    return (glm::dvec3(s.sum) + glm::dvec3(s.sumError)) / double(s.count);
}

/// Variance of the samples, with n (not n - 1) in the denominator.
glm::dvec3 variance(const PixelState& s) {
    return (glm::dvec3(s.m2) + glm::dvec3(s.m2Error)) / double(s.count);
}

class Accumulate : public DeviceTest {
  protected:
    /// Gives every pixel `samples` more, at most `perDispatch` at a time (an even number).
    void add(std::vector<AccumulateQuery>& pixels, uint32_t samples,
             uint32_t perDispatch = kMostPerDispatch) {
        for (uint32_t done = 0; done < samples; done += perDispatch) {
            for (AccumulateQuery& q : pixels)
                q.count = std::min(perDispatch, samples - done);
            const auto answers = ask<AccumulateAnswer>(shader_, pixels);
            for (size_t i = 0; i < pixels.size(); ++i) {
                pixels[i].state = answers[i].state;
                pixels[i].naiveSum = answers[i].naiveSum;
            }
        }
    }

  private:
    TestShader shader_{accumulate_shader};
};

TEST_F(Accumulate, TenMillionConstantSamples) {
    constexpr uint32_t kSamples = 10000000;
    const glm::vec3 value(0.5f, 0.1f, 0.7f);
    std::vector<AccumulateQuery> pixels = {pixel(value, value)};
    add(pixels, kSamples);
    const PixelState& s = pixels[0].state;
    ASSERT_EQ(s.count, kSamples);
    EXPECT_EQ(s.rejected, 0u);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(mean(s)[c], value[c], 1e-6);
        // The running mean is rounded to float where deviations from it are formed.
        EXPECT_LT(variance(s)[c], std::pow(0x1p-23 * value[c], 2));
        EXPECT_GE(variance(s)[c], 0);
    }
    const glm::dvec3 naive = glm::dvec3(pixels[0].naiveSum) / double(kSamples);
    EXPECT_GT(std::abs(naive.y - value.y), 1e-4) << "negative control: a float sum drifts";
    EXPECT_GT(std::abs(naive.z - value.z), 1e-4) << "negative control: a float sum drifts";
}

TEST_F(Accumulate, SmallDeviationsFromALargeMean) {
    constexpr uint32_t kSamples = 1200000;
    const glm::vec3 high(1e4f + 1e-2f, 1e4f + 1, 1), low(1e4f - 1e-2f, 1e4f - 1, 0);
    std::vector<AccumulateQuery> pixels = {pixel(high, low)};
    add(pixels, kSamples);
    for (int c = 0; c < 3; ++c) {
        const double a = high[c], b = low[c], half = (a - b) / 2;
        EXPECT_NEAR(mean(pixels[0].state)[c], (a + b) / 2, 1e-9 * a);
        // The mean is rounded by up to half an ulp of 1e4, 2^-11; the error linear in the
        // deviation cancels over its signs, its square does not.
        const double rounding = c < 2 ? 0x1p-11 * 0x1p-11 : 0x1p-48;
        EXPECT_NEAR(variance(pixels[0].state)[c], half * half, 4 * rounding + 1e-5 * half * half);
    }
}

/// The distribution of the shader's samples, in double.
glm::dvec3 drawn(uint32_t pixelId, uint32_t sample, const glm::vec3& scale);

TEST_F(Accumulate, RandomSamplesAgainstWelfordInDouble) {
    constexpr uint32_t kPixels = 64, kSamples = 40000;
    std::vector<AccumulateQuery> pixels;
    for (uint32_t i = 0; i < kPixels; ++i) {
        pixels.push_back(pixel(glm::vec3(1, 1e-6f, 1e5f), {}));
        pixels.back().random = i + 1;
    }
    add(pixels, kSamples);
    for (uint32_t i = 0; i < kPixels; ++i) {
        glm::dvec3 average(0.0), m2(0.0);
        for (uint32_t k = 0; k < kSamples; ++k) {
            const glm::dvec3 x = drawn(i + 1, k, pixels[i].even), before = x - average;
            average += before / double(k + 1);
            m2 += before * (x - average);
        }
        for (int c = 0; c < 3; ++c) {
            EXPECT_NEAR(mean(pixels[i].state)[c] / average[c], 1, 1e-6);
            EXPECT_NEAR(variance(pixels[i].state)[c] / (m2[c] / kSamples), 1, 1e-5);
        }
    }
}

TEST_F(Accumulate, HowSamplesAreCutIntoDispatchesChangesNoBit) {
    const glm::vec3 even(0.1f, 3e4f, 1e-9f), odd(1e3f, 0.3f, 7);
    std::vector<AccumulateQuery> once = {pixel(even, odd)}, often = once;
    add(once, 3000);
    add(often, 3000, 14);
    EXPECT_TRUE(sameBits(once[0].state, often[0].state));
}

TEST_F(Accumulate, BadSamplesAreRejectedAndCounted) {
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    const float bad[] = {nan, -nan, infinity, -infinity, -1e-6f, 1e38f, 0x1.000002p48f};
    constexpr uint32_t kAt = 11, kSamples = 100;
    const glm::vec3 even(0.25f, 1, 2), odd(0.75f, 0, 9);
    std::vector<AccumulateQuery> pixels, without = {pixel(even, odd)};
    for (const float x : bad)
        for (int c = 0; c < 3; ++c) {
            pixels.push_back(pixel(even, odd)); // a neighbour
            pixels.push_back(pixel(even, odd));
            pixels.back().injectAt = kAt;
            pixels.back().injected = even;
            pixels.back().injected[c] = x;
        }
    add(pixels, kSamples);
    add(without, kSamples);
    for (size_t i = 0; i < pixels.size(); i += 2) {
        EXPECT_TRUE(sameBits(pixels[i].state, without[0].state)) << i << ": neighbour touched";
        const PixelState& s = pixels[i + 1].state;
        EXPECT_EQ(s.rejected, 1u) << i;
        EXPECT_EQ(s.count, kSamples - 1) << i;
        EXPECT_EQ(s.firstRejected, kAt) << i;
        const double n = kSamples - 1; // odd sample 11 is missing
        EXPECT_NEAR(mean(s).x, (50 * 0.25 + 49 * 0.75) / n, 1e-7) << i;
        EXPECT_NEAR(mean(s).z, (50 * 2.0 + 49 * 9.0) / n, 1e-6) << i;
        EXPECT_TRUE(std::isfinite(variance(s).x + variance(s).y + variance(s).z)) << i;
    }
}

TEST_F(Accumulate, FirstRejectedStaysTheFirst) {
    std::vector<AccumulateQuery> pixels = {pixel(glm::vec3(1), glm::vec3(-1))};
    pixels[0].injectAt = 5;
    pixels[0].injected = glm::vec3(2);
    add(pixels, 1000, 100);
    const PixelState& s = pixels[0].state;
    EXPECT_EQ(s.count, 500u + 10u);
    EXPECT_EQ(s.rejected, 490u);
    EXPECT_EQ(s.firstRejected, 1u) << "sample 0 was good, sample 1 was not";
}

TEST_F(Accumulate, LargestAndSmallestSamplesCount) {
    const float largest = 0x1p48f;
    std::vector<AccumulateQuery> pixels = {pixel(glm::vec3(largest), glm::vec3(0.0f))};
    add(pixels, 50000);
    const PixelState& s = pixels[0].state;
    EXPECT_EQ(s.count, 50000u);
    EXPECT_EQ(s.rejected, 0u);
    EXPECT_NEAR(mean(s).x / largest, 0.5, 1e-7);
    EXPECT_NEAR(variance(s).x / (double(largest) * largest), 0.25, 1e-6);
}

glm::dvec3 drawn(uint32_t pixelId, uint32_t sample, const glm::vec3& scale) {
    // random.glsl, whose words random_test.cpp compares with the paper's.
    uint32_t v[4] = {pixelId, sample, 0, 0};
    for (uint32_t& word : v)
        word = word * 1664525u + 1013904223u;
    for (int pass = 0; pass < 2; ++pass) {
        v[0] += v[1] * v[3];
        v[1] += v[2] * v[0];
        v[2] += v[0] * v[1];
        v[3] += v[1] * v[2];
        for (uint32_t& word : v)
            if (pass == 0) word ^= word >> 16;
    }
    glm::dvec3 x;
    for (int c = 0; c < 3; ++c)
        x[c] = scale[c] / (1.0f - float(v[c] >> 8) * 0x1p-24f);
    return x;
}

} // namespace
} // namespace stromboli::test
