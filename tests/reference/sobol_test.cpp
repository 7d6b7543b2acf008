// The reference's sampler from its definitions.
#include "host/reference/sampling.hpp"

#include <gtest/gtest.h>

#include <bitset>
#include <cmath>
#include <set>
#include <vector>

namespace stromboli::reference {
namespace {

/// Sobol's first points as published with the direction numbers of Joe and Kuo (2008), dimensions 1
/// to 4, their Gray code order undone.
TEST(Sobol, FirstPointsArePublishedOnes) {
    constexpr double kPoints[8][4] = {{0, 0, 0, 0},
                                      {0.5, 0.5, 0.5, 0.5},
                                      {0.25, 0.75, 0.75, 0.75},
                                      {0.75, 0.25, 0.25, 0.25},
                                      {0.125, 0.625, 0.375, 0.125},
                                      {0.625, 0.125, 0.875, 0.625},
                                      {0.375, 0.375, 0.625, 0.875},
                                      {0.875, 0.875, 0.125, 0.375}};
    for (uint32_t i = 0; i < 8; ++i)
        for (size_t d = 0; d < 4; ++d)
            EXPECT_EQ(sobolPoint(i)[d] * 0x1p-32, kPoints[i][d]) << i << " " << d;
}

/// Numbers with k digits in common keep exactly k digits in common.
TEST(Sobol, ScramblingIsNested) {
    for (uint64_t key : {0u, 1u, 99u})
        for (int k = 0; k < 32; ++k) {
            const uint32_t a = 0x9E3779B9u, b = a ^ 0x80000000u >> k;
            const auto x = uint32_t(owenScrambled(a, key) * 0x1p32),
                       y = uint32_t(owenScrambled(b, key) * 0x1p32);
            EXPECT_EQ(__builtin_clz(x ^ y), k);
        }
}

/// Each digit is flipped by a fair bit that belongs to the digits before it alone: over many keys
/// half of the time, and as often together with any other one as not. 255 bits, 32,385 pairs.
TEST(Sobol, EveryBeginningHasAFlipOfItsOwn) {
    constexpr uint32_t kDigits = 8, kKeys = 4096;
    std::vector<std::bitset<kKeys>> flips;
    for (uint32_t k = 0; k < kDigits; ++k)
        for (uint32_t before = 0; before < 1u << k; ++before) {
            const uint32_t digits = k == 0 ? 0 : before << (32 - k);
            std::bitset<kKeys>& ofThis = flips.emplace_back();
            for (uint32_t key = 0; key < kKeys; ++key)
                ofThis[key] = uint32_t(owenScrambled(digits, key) * 0x1p32) >> (31 - k) & 1;
        }
    // Bernoulli's sums leave 6 standard deviations once in 5e8; there are 3e4 of them.
    const double bound = 6 * std::sqrt(kKeys) / 2;
    for (size_t i = 0; i < flips.size(); ++i) {
        EXPECT_NEAR(double(flips[i].count()), kKeys / 2, bound) << i;
        for (size_t j = 0; j < i; ++j)
            EXPECT_NEAR(double((flips[i] ^ flips[j]).count()), kKeys / 2, bound) << i << " " << j;
    }
}

TEST(Sobol, ShufflingKeepsRunsTogether) {
    for (uint32_t k : {0u, 3u, 10u}) {
        std::set<uint32_t> runs, indices;
        for (uint32_t i = 0; i < 1u << k; ++i) {
            const uint32_t index = owenShuffled((5u << k) + i, 17);
            EXPECT_LT(index, 1u << 24);
            runs.insert(index >> k);
            indices.insert(index);
        }
        EXPECT_EQ(runs.size(), 1u);
        EXPECT_EQ(indices.size(), size_t(1) << k);
    }
}

TEST(Sobol, StreamsFillTheSquareEvenlyInEveryBlock) {
    constexpr uint32_t kCount = 256;
    for (int block = 0; block < 3; ++block)
        for (uint32_t a = 0; a <= 8; ++a) {
            std::set<uint32_t> cells;
            for (uint32_t i = 0; i < kCount; ++i) {
                RandomStream random(3, kCount + i, 4, Sampler::Sobol);
                for (int b = 0; b < block; ++b) {
                    random.next(); // a block is left with numbers unused
                    random.beginBlock();
                }
                const double u = random.next(), v = random.next();
                cells.insert(uint32_t(u * (1u << a)) << (8 - a) | uint32_t(v * (256u >> a)));
            }
            EXPECT_EQ(cells.size(), kCount) << block;
        }
}

TEST(Sobol, NumbersAreUniformAndBlocksIndependent) {
    constexpr uint32_t kCount = 40000;
    double sum[8] = {}, products = 0, neighbours = 0;
    for (uint32_t pixel = 0; pixel < kCount; ++pixel) {
        RandomStream random(pixel, 9, 1, Sampler::Sobol), next(pixel + 1, 9, 1, Sampler::Sobol);
        double u[8];
        for (size_t i = 0; i < 8; ++i) {
            sum[i] += u[i] = random.next() - 0.5;
            EXPECT_LT(u[i], 0.5);
        }
        products += 12 * u[0] * u[4] / kCount;
        neighbours += 12 * u[0] * (next.next() - 0.5) / kCount;
    }
    for (double s : sum)
        EXPECT_NEAR(s / kCount, 0, 4.5 * std::sqrt(1.0 / 12 / kCount));
    EXPECT_NEAR(products, 0, 4.5 / std::sqrt(kCount));
    EXPECT_NEAR(neighbours, 0, 4.5 / std::sqrt(kCount));
}

} // namespace
} // namespace stromboli::reference
