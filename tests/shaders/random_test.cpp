// random.glsl: the words bit for bit, the numbers below 1, uniform and uncorrelated.
#include "tests/shaders/random_answers.hpp"
#include "tests/support/chi_square.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/test_shader.hpp"

#include "embedded/random_shader.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <random>

namespace stromboli::test {
namespace {

using gpu::RandomAnswer;
using gpu::RandomQuery;
using Words = std::array<uint32_t, 4>;

/// From the paper (Jarzynski and Olano 2020, listing of pcg4d), as two passes of one mixing step.
Words hash(Words v) {
    constexpr uint32_t kMultiplier = 1664525, kIncrement = 1013904223;
    for (uint32_t& word : v)
        word = word * kMultiplier + kIncrement;
    const auto mix = [&v] {
        constexpr int kFirst[] = {1, 2, 0, 1}, kSecond[] = {3, 0, 1, 2};
        for (size_t i = 0; i < 4; ++i)
            v[i] += v[size_t(kFirst[i])] * v[size_t(kSecond[i])];
    };
    mix();
    for (uint32_t& word : v)
        word ^= word >> 16;
    mix();
    return v;
}

class RandomShader : public DeviceTest {
  protected:
    std::vector<RandomAnswer> answers(const std::vector<RandomQuery>& queries) {
        return ask<RandomAnswer>(random_shader, queries);
    }
};

constexpr uint32_t kMany = 1000000;

TEST_F(RandomShader, WordsAreThoseOfThePaper) {
    std::mt19937 engine(1);
    std::vector<RandomQuery> queries(kMany);
    for (uint32_t i = 0; i < kMany; ++i) // counters as a picture has them, and any words
        queries[i] = i % 2 ? RandomQuery{i, i / 1000, i % 17, 0}
                           : RandomQuery{uint32_t(engine()), uint32_t(engine()), uint32_t(engine()),
                                         uint32_t(engine())};
    const std::vector<RandomAnswer> found = answers(queries);
    for (uint32_t i = 0; i < kMany; ++i) {
        const RandomQuery& q = queries[i];
        const Words expected = hash({q.x, q.y, q.z, q.w});
        for (size_t k = 0; k < 4; ++k) {
            ASSERT_EQ(found[i].hashed[k], expected[k]) << i;
            // 24 bits and a power of two: exact.
            ASSERT_EQ(found[i].block[k], float(expected[k] >> 8) * 0x1p-24f) << i;
        }
    }
}

TEST_F(RandomShader, NumbersStayBelowOne) {
    const std::vector<RandomQuery> queries = {{0xFFFFFFFF, 0xFFFFFF80, 0xFFFFFF7F, 0xFFFFFF00},
                                              {0, 0xFF, 0x100, 0x80000000}};
    const std::vector<RandomAnswer> found = answers(queries);
    for (float u : found[0].units)
        EXPECT_EQ(u, 1 - 0x1p-24f);
    EXPECT_EQ(found[1].units[0], 0);
    EXPECT_EQ(found[1].units[1], 0);
    EXPECT_EQ(found[1].units[2], 0x1p-24f);
    EXPECT_EQ(found[1].units[3], 0.5f);
}

/// Numbers of neighbours in every direction that counters have: next pixel, next row, next
/// sample, next block, next seed.
const std::vector<std::pair<const char*, RandomQuery>> kSteps = {{"pixel", {1, 0, 0, 0}},
                                                                 {"row", {800, 0, 0, 0}},
                                                                 {"sample", {0, 1, 0, 0}},
                                                                 {"block", {0, 0, 1, 0}},
                                                                 {"seed", {0, 0, 0, 1}}};

std::vector<RandomQuery> pictureCounters(const RandomQuery& step) {
    std::vector<RandomQuery> queries(kMany);
    for (uint32_t i = 0; i < kMany; ++i)
        queries[i] = {i % 10000 + step.x, i / 10000 + step.y, i % 7 + step.z, step.w};
    return queries;
}

TEST_F(RandomShader, UniformInEveryComponent) {
    constexpr size_t kBins = 256;
    const std::vector<RandomAnswer> found = answers(pictureCounters({}));
    const std::vector<double> expected(kBins, double(kMany) / kBins);
    for (size_t k = 0; k < 4; ++k) {
        std::vector<double> high(kBins), low(kBins);
        for (const RandomAnswer& a : found) {
            const auto bits = uint32_t(a.block[k] * 0x1p24f);
            ++high[bits >> 16];
            ++low[bits & 255];
        }
        EXPECT_GT(chiSquareTest(high, expected), sidakLevel(0.01, 8)) << k;
        EXPECT_GT(chiSquareTest(low, expected), sidakLevel(0.01, 8)) << k;
    }
}

/// The fifth number of a block is uniform whatever the others are, with both samplers.
TEST_F(RandomShader, LeftOverDigitsAreAFifthNumber) {
    constexpr uint32_t kSide = 16;
    const std::vector<double> each(kSide * kSide, double(kMany) / (kSide * kSide));
    const double level = sidakLevel(0.01, 2 * 5);
    for (const uint32_t sampler : {gpu::SAMPLER_INDEPENDENT, gpu::SAMPLER_SOBOL}) {
        const auto found = ask<RandomAnswer>(random_shader, pictureCounters({}),
                                             ShaderOptions().set(SPEC_SAMPLER, sampler));
        for (size_t k = 0; k < 4; ++k) {
            std::vector<double> held(kSide * kSide);
            for (const RandomAnswer& a : found) {
                ASSERT_GE(a.leftOver, 0);
                ASSERT_LT(a.leftOver, 1);
                ++held[uint32_t(a.block[k] * kSide) * kSide + uint32_t(a.leftOver * kSide)];
            }
            EXPECT_GT(chiSquareTest(held, each), level) << sampler << ' ' << k;
        }
        std::vector<double> low(kSide * kSide); // digits 17 to 24
        for (const RandomAnswer& a : found)
            ++low[uint32_t(a.leftOver * 0x1p24f) & 0xFF];
        EXPECT_GT(chiSquareTest(low, each), level) << sampler;
    }
}

/// A correlation of 0.01 is ten standard deviations here.
TEST_F(RandomShader, NeighboursAreUncorrelated) {
    const std::vector<RandomAnswer> base = answers(pictureCounters({}));
    for (const auto& [name, step] : kSteps) {
        const std::vector<RandomAnswer> next = answers(pictureCounters(step));
        for (size_t i = 0; i < 4; ++i)
            for (size_t j = 0; j < 4; ++j)
                EXPECT_LT(std::abs(correlation(base, i, next, j)), 0.01) << name << i << j;
    }
    for (size_t i = 0; i < 4; ++i) // within a block
        for (size_t j = 0; j < i; ++j)
            EXPECT_LT(std::abs(correlation(base, i, base, j)), 0.01) << i << j;
}

/// Numbers below 2^31 whose quotients are below 2^21, multiples of the divisor and their neighbours
/// among them.
TEST_F(RandomShader, QuotientsAndRestsAreExact) {
    std::mt19937 engine(2);
    std::vector<RandomQuery> queries;
    for (uint32_t i = 0; i < kMany; ++i) {
        const uint32_t divisor = std::max(uint32_t(engine()) >> (1 + engine() % 31), 1u);
        const uint64_t most = std::min<uint64_t>(uint64_t(divisor) << 21, 1u << 31);
        uint64_t x = (uint64_t(engine()) << 32 | engine()) % most;
        if (i % 2 == 0) x = x / divisor * divisor;
        if (i % 8 == 0 && x > 0) --x;
        queries.push_back({uint32_t(x), divisor, 0, 0});
    }
    const std::vector<RandomAnswer> found = answers(queries);
    for (uint32_t i = 0; i < kMany; ++i) {
        const RandomQuery& q = queries[i];
        ASSERT_EQ(found[i].quotient, q.x / q.y) << q.x << " / " << q.y;
        ASSERT_EQ(found[i].rest, q.x % q.y) << q.x << " / " << q.y;
    }
}

} // namespace
} // namespace stromboli::test
