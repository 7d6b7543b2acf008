// sobol.glsl: Sobol's points bit for bit from their direction numbers; evenness in every run of 2^k
// samples; uniform, and uncorrelated between pixels, blocks and dimensions. Statistical tests have
// .01 for the file together.
#include "host/reference/sampling.hpp"
#include "tests/shaders/random_answers.hpp"
#include "tests/support/chi_square.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/test_shader.hpp"

#include "embedded/random_shader.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace stromboli::test {
namespace {

using gpu::RandomAnswer;
using gpu::RandomQuery; ///< x, y, z, w: pixel, sample, block, seed
using Words = std::array<uint32_t, 4>;

const double kLevel = sidakLevel(0.01, 16);

uint32_t reversed(uint32_t x) {
    uint32_t r = 0;
    for (int i = 0; i < 32; ++i)
        r |= (x >> i & 1) << (31 - i);
    return r;
}

/// Nested uniform scrambling by the hash of the shader's source, of a number as it is.
uint32_t scrambled(uint32_t number, uint32_t key) {
    uint32_t x = reversed(number);
    x ^= x * 0x3D20ADEAu;
    x = (x + key) * (key >> 16 | 1);
    x ^= x * 0x05526C56u;
    x ^= x * 0x53A22864u;
    return reversed(x);
}

/// What a block should be: `hash` is pcg4d of (pixel, sequence, block, seed), which random_test.cpp
/// compares with its paper.
Words expectedWords(const uint32_t* hash, uint32_t sample) {
    const uint32_t index = scrambled(sample, hash[0] + hash[2]) & 0xFFFFFF;
    const auto point = reference::sobolPoint(index);
    Words words;
    for (size_t d = 0; d < 4; ++d)
        words[d] = scrambled(point[d], hash[d]);
    return words;
}

class SobolShader : public DeviceTest {
  protected:
    static std::vector<RandomAnswer> answers(const std::vector<RandomQuery>& queries,
                                             uint32_t sampler = gpu::SAMPLER_SOBOL) {
        return ask<RandomAnswer>(random_shader, queries,
                                 ShaderOptions().set(SPEC_SAMPLER, sampler));
    }
};

/// A coordinate in units of 2^-24.
uint32_t digits(const RandomAnswer& a, size_t dimension) {
    return uint32_t(a.block[dimension] * 0x1p24f);
}

TEST_F(SobolShader, PointsAreThoseOfTheDirectionNumbers) {
    std::mt19937 engine(11);
    std::vector<RandomQuery> queries, keys;
    for (uint32_t i = 0; i < 200000; ++i) {
        // As pictures have them; any below 2^24; beyond, where another sequence begins.
        const uint32_t bits = i % 3 == 0 ? 10 : i % 3 == 1 ? 24 : 32;
        queries.push_back({uint32_t(engine()) >> 8, uint32_t(engine()) >> (32 - bits),
                           uint32_t(engine()) % 40, uint32_t(engine())});
        keys.push_back(queries.back());
        keys.back().y >>= 24;
    }
    const std::vector<RandomAnswer> found = answers(queries), hashes = answers(keys);
    for (size_t i = 0; i < found.size(); ++i) {
        const Words expected = expectedWords(hashes[i].hashed, queries[i].y);
        for (size_t d = 0; d < 4; ++d)
            ASSERT_EQ(digits(found[i], d), expected[d] >> 8) << i << " dimension " << d;
    }
}

/// Whether every elementary interval with 2^-k[d] on axis d holds `each` of the points.
bool fillsEvenly(const RandomAnswer* points, size_t count, const std::array<uint32_t, 4>& k,
                 uint32_t each) {
    std::vector<uint32_t> held(count / each);
    for (size_t i = 0; i < count; ++i) {
        size_t cell = 0;
        for (size_t d = 0; d < 4; ++d)
            cell = cell << k[d] | digits(points[i], d) >> (24 - k[d]);
        ++held[cell];
    }
    return std::all_of(held.begin(), held.end(), [&](uint32_t n) { return n == each; });
}

/// Whether 2^k points are a (t, k, 4)-net in base 2: an elementary interval of volume 2^(t-k) has
/// 2^t.
bool isNet(const RandomAnswer* points, uint32_t k, uint32_t t) {
    const uint32_t sum = k - t;
    for (uint32_t a = 0; a <= sum; ++a)
        for (uint32_t b = 0; a + b <= sum; ++b)
            for (uint32_t c = 0; a + b + c <= sum; ++c)
                if (!fillsEvenly(points, size_t(1) << k, {a, b, c, sum - a - b - c}, 1u << t))
                    return false;
    return true;
}

constexpr uint32_t kRun = 1024;

std::vector<RandomQuery> runOf(uint32_t pixel, uint32_t block) {
    std::vector<RandomQuery> queries;
    for (uint32_t i = 0; i < kRun; ++i)
        queries.push_back({pixel, 3 * kRun + i, block, 7});
    return queries;
}

TEST_F(SobolShader, EveryRunFillsTheSquareAndTheCubeEvenly) {
    for (uint32_t pixel : {0u, 1u, 4711u})
        for (uint32_t block : {0u, 5u}) {
            const std::vector<RandomAnswer> found = answers(runOf(pixel, block));
            for (uint32_t k = 0; k <= 10; ++k)
                for (size_t first = 0; first < kRun; first += size_t(1) << k) {
                    const RandomAnswer* run = &found[first];
                    for (uint32_t a = 0; a <= k; ++a) // a (0, k, 2)-net in the first two dimensions
                        ASSERT_TRUE(fillsEvenly(run, size_t(1) << k, {a, k - a, 0, 0}, 1)) << k;
                    for (size_t d = 2; d < 4; ++d) { // a (0, k, 1)-net in the others
                        std::array<uint32_t, 4> along{};
                        along[d] = k;
                        ASSERT_TRUE(fillsEvenly(run, size_t(1) << k, along, 1)) << k;
                    }
                }
            // t of Sobol's sequence: the sum of degree - 1 of the polynomials, 0 + 0 + 1 + 2.
            for (uint32_t k : {4u, 7u, 9u})
                EXPECT_TRUE(isNet(&found[0], k, 3));
        }
    const std::vector<RandomAnswer> control = answers(runOf(0, 0), gpu::SAMPLER_INDEPENDENT);
    EXPECT_FALSE(fillsEvenly(&control[0], 16, {2, 2, 0, 0}, 1));
    EXPECT_FALSE(isNet(&control[0], 9, 3));
}

/// One sample of each of many pixels: what a sample is by itself.
std::vector<RandomQuery> oneSample(uint32_t sample, const RandomQuery& step = {}) {
    std::vector<RandomQuery> queries;
    for (uint32_t i = 0; i < 250000; ++i)
        queries.push_back({i + step.x, sample + step.y, i % 7 + step.z, step.w});
    return queries;
}

TEST_F(SobolShader, EachSampleIsUniformInTheCube) {
    constexpr size_t kGrid = 6; // 1296 cells, no power of two
    for (uint32_t sample : {0u, 1u, 63u, 1000u}) {
        const std::vector<RandomAnswer> found = answers(oneSample(sample));
        std::vector<double> cells(kGrid * kGrid * kGrid * kGrid), low(256);
        for (const RandomAnswer& a : found) {
            size_t cell = 0;
            for (float u : a.block) {
                ASSERT_GE(u, 0);
                ASSERT_LT(u, 1);
                cell = cell * kGrid + size_t(u * float(kGrid));
            }
            ++cells[cell];
            ++low[digits(a, sample % 4) & 255]; // the last digits
        }
        const auto even = [&](const std::vector<double>& bins) {
            const std::vector<double> expected(bins.size(),
                                               double(found.size()) / double(bins.size()));
            return chiSquareTest(bins, expected);
        };
        EXPECT_GT(even(cells), kLevel) << sample;
        EXPECT_GT(even(low), kLevel) << sample;
    }
}

/// Correlation of uniform numbers; deviation n^-1/2 = .002.
TEST_F(SobolShader, PixelsBlocksSeedsAndDimensionsAreUncorrelated) {
    const std::vector<RandomAnswer> base = answers(oneSample(5));
    for (const RandomQuery& step :
         {RandomQuery{1, 0, 0, 0}, {800, 0, 0, 0}, {1, 1, 0, 0}, {0, 0, 1, 0}, {0, 0, 0, 1}}) {
        const std::vector<RandomAnswer> next = answers(oneSample(5, step));
        for (size_t i = 0; i < 4; ++i)
            for (size_t j = 0; j < 4; ++j)
                EXPECT_LT(std::abs(correlation(base, i, next, j)), 0.01) << i << j;
    }
    for (size_t i = 0; i < 4; ++i)
        for (size_t j = 0; j < i; ++j)
            EXPECT_LT(std::abs(correlation(base, i, base, j)), 0.01) << i << j;
}

/// A function of mean 1 / 8 with a diagonal edge, and its error in the mean of n samples, by pixel.
std::vector<double> errors(const std::vector<RandomAnswer>& found, uint32_t n) {
    std::vector<double> errors;
    for (size_t first = 0; first < found.size(); first += n) {
        double sum = 0;
        for (size_t i = first; i < first + n; ++i)
            sum += found[i].block[0] + found[i].block[1] < 0.5f;
        errors.push_back(sum / n - 0.125);
    }
    return errors;
}

double meanSquare(const std::vector<double>& values) {
    double sum = 0;
    for (double v : values)
        sum += v * v;
    return sum / double(values.size());
}

std::vector<RandomQuery> pixelsOf(uint32_t n) {
    std::vector<RandomQuery> queries;
    for (uint32_t i = 0; i < 400000 / n * n; ++i)
        queries.push_back({i / n, i % n, 2, 3});
    return queries;
}

/// Along an edge in the square, 2^k points of a scrambled net have an error of order n^-3/2 in
/// variance (about sqrt(n) of n cells are cut); independent ones n^-1.
TEST_F(SobolShader, ErrorFallsAsOfAScrambledNet) {
    const auto variance = [](uint32_t n, uint32_t sampler) {
        return meanSquare(errors(answers(pixelsOf(n), sampler), n));
    };
    const auto slope = [&](uint32_t sampler) {
        return std::log(variance(256, sampler) / variance(16, sampler)) / std::log(16.0);
    };
    // From 1,562 pixels a variance has a deviation of 4 %: .015 of the slope.
    EXPECT_NEAR(slope(gpu::SAMPLER_SOBOL), -1.5, 0.1);
    EXPECT_NEAR(slope(gpu::SAMPLER_INDEPENDENT), -1, 0.07);
}

TEST_F(SobolShader, ErrorsOfNeighboursAreUncorrelatedAndAverageOut) {
    const std::vector<double> e = errors(answers(pixelsOf(16)), 16);
    double product = 0, sum = 0;
    for (size_t i = 0; i + 1 < e.size(); ++i)
        product += e[i] * e[i + 1], sum += e[i];
    const double n = double(e.size()), variance = meanSquare(e);
    EXPECT_LT(std::abs(product / n / variance), 4.5 / std::sqrt(n));
    EXPECT_LT(std::abs(sum / n), 4.5 * std::sqrt(variance / n)) << "biased";
}

} // namespace
} // namespace stromboli::test
