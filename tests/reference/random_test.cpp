#include "host/reference/sampling.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <thread>
#include <vector>

namespace stromboli::reference {
namespace {

TEST(Random, PhiloxMatchesItsPublishedVectors) {
    // kat_vectors of the Random123 library, philox4x32 with 10 rounds.
    using Words = std::array<uint32_t, 4>;
    EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}),
              (Words{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
    EXPECT_EQ(philox({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, {0xffffffff, 0xffffffff}),
              (Words{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
    EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
              (Words{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Random, UniformInTheUnitInterval) {
    double sum = 0, sum2 = 0;
    constexpr int kCount = 100000;
    RandomStream random(1, 2, 3);
    for (int i = 0; i < kCount; ++i) {
        const double u = random.next();
        ASSERT_GE(u, 0);
        ASSERT_LT(u, 1);
        sum += u;
        sum2 += u * u;
    }
    // Deviations of the mean of u and u^2: sqrt(1/12 / n), sqrt(4/45 / n); 4.5 of each.
    EXPECT_NEAR(sum / kCount, 0.5, 4.5 * std::sqrt(1.0 / 12 / kCount));
    EXPECT_NEAR(sum2 / kCount, 1.0 / 3, 4.5 * std::sqrt(4.0 / 45 / kCount));
}

TEST(Random, BranchesTakeNumbersThatNoPathTakes) {
    for (const Sampler sampler : {Sampler::Independent, Sampler::Sobol}) {
        std::set<double> numbers;
        size_t drawn = 0;
        const auto draw = [&](RandomStream& stream) {
            for (int i = 0; i < 12; ++i, ++drawn)
                numbers.insert(stream.next());
        };
        for (uint32_t sample = 0; sample < 16; ++sample) {
            RandomStream stream(7, sample, 0, sampler);
            draw(stream);
            for (uint32_t branch = 0; branch < 4; ++branch) {
                RandomStream part = stream.branch(branch, 4);
                draw(part);
            }
        }
        EXPECT_EQ(numbers.size(), drawn); // of 53 bits: two are equal once in 2^33
    }
}

TEST(Random, StreamsOfNeighboursAreNotCorrelated) {
    // 12 times the covariance of two uniform numbers has deviation 1 / sqrt(n).
    constexpr uint32_t kCount = 100000;
    double pixels = 0, samples = 0, seeds = 0;
    for (uint32_t i = 0; i < kCount; ++i) {
        const double u = RandomStream(i, 0, 0).next() - 0.5;
        pixels += 12 * u * (RandomStream(i + 1, 0, 0).next() - 0.5) / kCount;
        samples += 12 * u * (RandomStream(i, 1, 0).next() - 0.5) / kCount;
        seeds += 12 * u * (RandomStream(i, 0, 1).next() - 0.5) / kCount;
    }
    EXPECT_NEAR(pixels, 0, 4.5 / std::sqrt(kCount));
    EXPECT_NEAR(samples, 0, 4.5 / std::sqrt(kCount));
    EXPECT_NEAR(seeds, 0, 4.5 / std::sqrt(kCount));
}

/// Numbers do not depend on what a thread has drawn before, though it remembers what the samples of
/// a pixel have in common: streams that differ in one of what names them, and blocks that lie as
/// far apart as it remembers, have the numbers that they have on a thread of their own.
TEST(Random, KnowsNothingOfOtherStreams) {
    struct Name {
        uint32_t pixel, sample, seed;
    };
    const std::vector<Name> names = {{0, 0, 0},        {0, 0, 1}, {1, 0, 0}, {0, 1, 0},
                                     {0, 1u << 24, 0}, {1, 0, 0}, {0, 0, 1}, {0, 0, 0}};
    const auto drawn = [](const Name& name, int count) {
        RandomStream stream(name.pixel, name.sample, name.seed, Sampler::Sobol);
        std::vector<double> numbers;
        for (int i = 0; i < count; ++i)
            numbers.push_back(stream.next());
        return numbers;
    };
    std::set<std::vector<double>> different;
    for (const int count : {4 * 3, 4 * 130}) // few blocks, and more than are remembered
        for (const Name& name : names) {
            const std::vector<double> here = drawn(name, count);
            std::vector<double> alone;
            std::thread([&] { alone = drawn(name, count); }).join();
            EXPECT_EQ(here, alone) << name.pixel << ", " << name.sample << ", " << name.seed;
            const std::set<double> numbers(alone.begin(), alone.end());
            EXPECT_EQ(numbers.size(), alone.size()) << "blocks are different";
            different.insert(alone);
        }
    EXPECT_EQ(different.size(), 2 * 5u);
}

} // namespace
} // namespace stromboli::reference
