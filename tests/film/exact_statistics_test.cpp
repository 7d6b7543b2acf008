// Sums that do not depend on order and grouping, against whole numbers of any size and Welford's
// update.
#include "host/core/error.hpp"
#include "host/film/film.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

namespace stromboli {
namespace {

using Sum = ExactStatistics::Sum;
using Squares = ExactStatistics::Squares;

/// A whole number of any size as bits, each counted as often as it was added: slow and plain.
class BitCounts {
  public:
    /// What the value has below 2^lowest is left out.
    void add(double value, int lowest) {
        for (int bit = 127; bit >= lowest; --bit)
            if (const double power = std::ldexp(1.0, bit); value >= power) {
                value -= power; // exact: the highest bit of the value
                ++counts_[bit];
            }
    }
    /// The words of the sum, each of 64 bits from 2^lowest on.
    template <size_t count>
    std::array<uint64_t, count> words(int lowest) const {
        std::array<uint64_t, count> result{};
        uint64_t carry = 0;
        for (size_t i = 0; i < 64 * count; ++i) {
            const auto found = counts_.find(lowest + int(i));
            carry += found == counts_.end() ? 0 : found->second;
            result[i / 64] |= (carry & 1) << (i % 64);
            carry >>= 1;
        }
        return result;
    }

  private:
    std::map<int, uint64_t> counts_;
};

/// Numbers of any size between 2^-60 and 2^48, and now and then one near the least of all doubles.
double anyRadiance(std::mt19937& random) {
    std::uniform_real_distribution<double> digits(1, 2), exponent(-60, 47);
    const double value = std::ldexp(digits(random), int(exponent(random)));
    return random() % 16 == 0 ? value * 1e-36 : value;
}

TEST(FixedSum, IsThatOfWholeNumbers) {
    std::mt19937 random(1);
    for (int trial = 0; trial < 20; ++trial) {
        Sum sum;
        BitCounts plain;
        for (int i = 0; i < 500; ++i) {
            const double value = anyRadiance(random);
            sum.add(value);
            plain.add(value, Sum::kLowest);
        }
        EXPECT_EQ(sum.words, plain.words<4>(Sum::kLowest));
    }
}

TEST(FixedSum, OfTwiceAsManyDigitsIsThatOfWholeNumbers) {
    std::mt19937_64 random(2);
    for (int trial = 0; trial < 200; ++trial) {
        Squares sum;
        BitCounts plain;
        for (int i = 0; i < 40; ++i) {
            const uint64_t high = random(), low = random();
            const int exponent = int(random() % 180) - 200;
            sum.add(uint128(high) << 64 | low, exponent);
            for (int bit = 0; bit < 64; ++bit) {
                if (low >> bit & 1) plain.add(std::ldexp(1.0, bit + exponent), Squares::kLowest);
                if (high >> bit & 1)
                    plain.add(std::ldexp(1.0, bit + 64 + exponent), Squares::kLowest);
            }
        }
        EXPECT_EQ(sum.words, plain.words<5>(Squares::kLowest));
    }
}

TEST(FixedSum, ComesBackAsTheNearestDouble) {
    std::mt19937 random(3);
    for (int i = 0; i < 10000; ++i) {
        const double value = anyRadiance(random);
        Sum sum;
        sum.add(value);
        if (value > 1e-30) { // all digits are above 2^-180
            EXPECT_EQ(sum.value(), value);
        }
        // Half of the last digit rounds to the even one of both neighbours; a bit more rounds up.
        if (value < 1e-3) continue;
        const double up = std::nextafter(value, INFINITY), half = (up - value) / 2;
        const bool isEven = std::bit_cast<uint64_t>(value) % 2 == 0;
        sum.add(half);
        EXPECT_EQ(sum.value(), isEven ? value : up);
        sum.add(1e-50);
        EXPECT_EQ(sum.value(), up);
    }
    EXPECT_EQ(Sum().value(), 0);
}

TEST(FixedSum, Differences) {
    std::mt19937 random(4);
    for (int i = 0; i < 1000; ++i) {
        Sum a, b;
        a.add(anyRadiance(random));
        b.add(anyRadiance(random));
        Sum both = a;
        both.add(b);
        EXPECT_EQ(both.less(a), b);
        EXPECT_EQ(both.less(b), a);
        EXPECT_EQ(a.less(a), Sum());
        if (b != Sum()) {
            EXPECT_EQ(a.less(both), Sum());
        }
    }
}

TEST(FixedSum, OfNumbersOfBothSigns) {
    std::mt19937 random(9);
    for (int trial = 0; trial < 200; ++trial) {
        Sum sum, positive, negative;
        for (int i = 0; i < 20; ++i) {
            const double value = anyRadiance(random);
            const bool isNegative = random() % 2 == 0;
            sum.add(isNegative ? -value : value);
            (isNegative ? negative : positive).add(value);
        }
        const bool isNegative = positive.less(negative) == Sum();
        EXPECT_EQ(sum.isNegative(), isNegative);
        const Sum size = isNegative ? negative.less(positive) : positive.less(negative);
        EXPECT_EQ(sum.magnitude(), size);
        EXPECT_EQ(sum.value(), isNegative ? -size.value() : size.value());
        sum.add(isNegative ? size.value() : -size.value());
        EXPECT_LE(std::abs(sum.value()), size.value() * 0x1p-53) << "of what was rounded";
    }
    Sum zero;
    zero.add(-0.0);
    EXPECT_EQ(zero, Sum());
}

/// hasSigns: some samples are negative, as pixel filters make them.
PixelStatistics blockOf(std::mt19937& random, uint32_t count, bool hasSigns = false) {
    PixelStatistics p;
    for (uint32_t i = 0; i < count; ++i)
        p.add(glm::dvec3(anyRadiance(random), anyRadiance(random), anyRadiance(random)),
              hasSigns && random() % 3 == 0 ? -1.25 : 1);
    return p;
}

TEST(ExactStatistics, DoNotDependOnOrderAndGrouping) {
    std::mt19937 random(5);
    std::vector<ExactStatistics> blocks(37);
    for (uint32_t i = 0; i < blocks.size(); ++i)
        blocks[i].add(blockOf(random, 1 + i % 5, i % 2 == 0), 10 * i);
    ExactStatistics inOrder;
    for (const ExactStatistics& block : blocks)
        inOrder.add(block);
    for (int trial = 0; trial < 50; ++trial) {
        std::vector<ExactStatistics> parts = blocks;
        while (parts.size() > 1) { // any two become one
            std::shuffle(parts.begin(), parts.end(), random);
            const ExactStatistics last = parts.back();
            parts.pop_back();
            parts.back().add(last);
        }
        EXPECT_EQ(parts.front(), inOrder);
    }
}

/// A render of a single block is that of a render without blocks.
TEST(ExactStatistics, OfOneBlockAreItsOwn) {
    std::mt19937 random(6);
    for (uint32_t count : {1u, 2u, 4u, 16u, 64u, 1024u}) // sums in doubles are the mean's, then
        for (int trial = 0; trial < 20; ++trial) {
            const PixelStatistics block = blockOf(random, count);
            ExactStatistics exact;
            exact.add(block, 0);
            const PixelStatistics back = exact.statistics();
            EXPECT_EQ(back.count, count);
            EXPECT_EQ(back.mean, block.mean);
            EXPECT_EQ(back.m2, block.m2);
        }
}

/// Against Welford's update, which rounds some 2^-53 of the sum of the absolute values each time.
TEST(ExactStatistics, OfSamplesOfBothSigns) {
    std::mt19937 random(10);
    std::uniform_real_distribution<double> radiance(0, 100);
    PixelStatistics all;
    ExactStatistics exact;
    for (uint32_t first = 0; first < 1000; first += 50) {
        PixelStatistics block;
        for (int i = 0; i < 50; ++i) {
            const glm::dvec3 value(radiance(random), 1, radiance(random));
            const double weight = random() % 2 == 0 ? 1.8 : -1.8;
            block.add(value, weight);
            all.add(value, weight);
        }
        exact.add(block, first);
    }
    const PixelStatistics together = exact.statistics();
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(together.mean[c], all.mean[c], 1000 * 0x1p-53 * 180);
        EXPECT_NEAR(together.m2[c], all.m2[c], 1000 * 0x1p-53 * all.m2[c]);
    }
}

TEST(ExactStatistics, EqualSamplesHaveNoDeviation) {
    std::mt19937 random(7);
    for (int trial = 0; trial < 200; ++trial) {
        const auto radiance = glm::dvec3(float(anyRadiance(random)), 0.1f, 1e-20f);
        ExactStatistics exact;
        for (uint32_t count : {64u, 64u, 7u, 36u, 1u}) { // not only powers of two
            PixelStatistics block;
            for (uint32_t i = 0; i < count; ++i)
                block.add(radiance);
            exact.add(block, 0);
        }
        EXPECT_EQ(exact.statistics().m2, glm::dvec3(0));
        EXPECT_EQ(exact.statistics().mean, radiance);
    }
}

/// Against Welford's update of all samples, which loses a few bits for each digit by which the mean
/// is larger than the deviations: 1000 roundings of 2^-53 here, and 10^3 squared of them.
TEST(ExactStatistics, AreThoseOfAllSamples) {
    std::mt19937 random(8);
    std::uniform_real_distribution<double> around(1000, 1001);
    PixelStatistics all;
    ExactStatistics exact;
    for (uint32_t first = 0; first < 1000; first += 50) {
        PixelStatistics block;
        for (int i = 0; i < 50; ++i) {
            const glm::dvec3 radiance(around(random), 1e-9 * around(random), around(random) - 1000);
            block.add(radiance);
            all.add(radiance);
        }
        exact.add(block, first);
    }
    const PixelStatistics together = exact.statistics();
    EXPECT_EQ(together.count, 1000u);
    for (int c = 0; c < 3; ++c) {
        EXPECT_NEAR(together.mean[c] / all.mean[c], 1, 1e-12);
        EXPECT_NEAR(together.m2[c] / all.m2[c], 1, 1e-7);
    }
}

TEST(ExactStatistics, CountRejectedSamplesFromTheFirstOfThePixel) {
    PixelStatistics good, bad;
    good.add(glm::dvec3(1));
    bad.add(glm::dvec3(1));
    bad.add(glm::dvec3(-1));
    ExactStatistics a, b;
    a.add(bad, 20);
    b.add(bad, 10);
    b.add(good, 0);
    a.add(b);
    EXPECT_EQ(a.statistics().count, 3u);
    EXPECT_EQ(a.statistics().rejected, 2u);
    EXPECT_EQ(a.statistics().firstRejected, 11u);
    EXPECT_EQ(a.taken(), 5u);
    EXPECT_EQ(ExactStatistics().statistics().firstRejected, PixelStatistics().firstRejected);
}

TEST(ExactStatistics, RefuseWhatIsTooBright) {
    PixelStatistics bright;
    bright.add(glm::dvec3(std::ldexp(1.0, 48)));
    ExactStatistics exact;
    for (int i = 0; i < 1000; ++i)
        exact.add(bright, 0);
    EXPECT_EQ(exact.statistics().mean.x, std::ldexp(1.0, 48));
    PixelStatistics brighter;
    brighter.add(glm::dvec3(1, std::ldexp(1.0, 49), 1));
    EXPECT_THROW(exact.add(brighter, 0), SceneError);
}

} // namespace
} // namespace stromboli
