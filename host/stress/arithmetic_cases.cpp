// What kernels take for granted of the device's floats (docs/numerics.md): IEEE 754 as the host has
// it. Where a device promises it, kernels ask for it (host/vulkan/instance.hpp).
#include "host/core/random.hpp"
#include "host/stress/case.hpp"

#include <fmt/format.h>

#include <bit>
#include <cmath>
#include <limits>

namespace stromboli::stress {
namespace {

constexpr float kInfinity = std::numeric_limits<float>::infinity();
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// In double, whose 53 digits hold products of floats whole and sums well enough that the second
/// rounding changes nothing (Figueroa 1995): the float nearest to the true result, ties to even.
FloatFacts expected(const FloatPair& p) {
    const double a = p.a, b = p.b;
    FloatFacts f;
    f.results = {float(a + b), float(a - b), float(a * b), -p.a};
    const bool isLess = a < b;
    f.comparisons = uint32_t(isLess) | uint32_t(a <= b) << 1 | uint32_t(a > b) << 2 |
                    uint32_t(a >= b) << 3 | uint32_t(a == b) << 4 | uint32_t(a != b) << 5 |
                    uint32_t(!isLess) << 6;
    return f;
}

bool isDenormal(float x) {
    return std::fpclassify(x) == FP_SUBNORMAL;
}

/// The same bits; any NaN for a NaN, and anything for a denormal, which a device may take for zero.
bool agrees(float found, float right) {
    if (std::isnan(right)) return std::isnan(found);
    return isDenormal(right) || std::bit_cast<uint32_t>(found) == std::bit_cast<uint32_t>(right);
}

std::string inWords(const FloatPair& p) {
    return fmt::format("of {:a} and {:a}", p.a, p.b);
}

/// All pairs of the numbers.
std::vector<FloatPair> pairsOf(const std::vector<float>& numbers) {
    std::vector<FloatPair> pairs;
    for (const float a : numbers)
        for (const float b : numbers)
            pairs.push_back({a, b});
    return pairs;
}

/// How many pairs have a result that is not IEEE's, or a comparison.
Finding compare(Run& run, const std::vector<FloatPair>& pairs, bool results, bool comparisons) {
    const std::vector<FloatFacts> found = run.subject().floatFacts(pairs);
    Finding f;
    f.trials = pairs.size();
    for (size_t i = 0; i < pairs.size(); ++i) {
        const FloatFacts right = expected(pairs[i]);
        bool wrong = comparisons && found.at(i).comparisons != right.comparisons;
        for (size_t k = 0; results && k < right.results.size(); ++k)
            wrong = wrong || !agrees(found.at(i).results[k], right.results[k]);
        if (!wrong) continue;
        ++f.measured;
        if (f.where.empty()) f.where = inWords(pairs[i]);
    }
    return f;
}

/// A NaN is neither below, nor above, nor equal to anything: rays and samples that are none are
/// left out by the same comparisons that others pass.
Finding comparisonsWithNaN(Run& run) {
    std::vector<FloatPair> pairs;
    for (const FloatPair& p : pairsOf({kNaN, -kNaN, 0.0f, -0.0f, 1.0f, -1.0f, 0x1p-126f,
                                       -3.402823466e38f, 3.402823466e38f, kInfinity, -kInfinity}))
        if (std::isnan(p.a) || std::isnan(p.b)) pairs.push_back(p);
    return compare(run, pairs, false, true);
}

/// Of rays in planes of boxes, and of lights that fall off to nothing: signs of zeros, infinity and
/// what is none of them.
Finding zerosAndInfinities(Run& run) {
    return compare(run,
                   pairsOf({0.0f, -0.0f, 1.0f, -1.0f, 3.0f, -0x1p-126f, 3.402823466e38f,
                            -3.402823466e38f, kInfinity, -kInfinity}),
                   true, true);
}

/// The error bounds, and the two floats of a pixel's sum. By turns any two numbers, and such whose
/// sum lies in the middle between two floats.
Finding roundingToEven(Run& run) {
    Random random(661);
    const auto any = [&](uint32_t exponents) { // of so many powers of two about 1
        const uint32_t exponent = 127 - exponents / 2 + random.word() % exponents;
        return std::bit_cast<float>((random.word() & 0x807FFFFFu) | exponent << 23);
    };
    std::vector<FloatPair> pairs(run.amount<size_t>(100'000, 10'000'000));
    for (size_t i = 0; i < pairs.size(); ++i) {
        const float a = any(i % 4 < 2 ? 40 : 4);
        const float half = std::ldexp(a > 0 ? 1.0f : -1.0f, std::ilogb(a) - 24);
        pairs[i] = {a, i % 2 ? any(40) : half};
    }
    return compare(run, pairs, true, true);
}

} // namespace

std::vector<Case> arithmeticCases() {
    return {
        {"nan-comparisons", "66", "a NaN is not below, above or equal to anything", "wrong",
         "pairs", comparisonsWithNaN},
        {"signed-zeros", "67", "infinity and signs of zero are what IEEE 754 makes of them",
         "wrong", "pairs", zerosAndInfinities},
        {"rounding", "68", "sums and products are the nearest floats, ties to even", "wrong",
         "pairs", roundingToEven},
    };
}

} // namespace stromboli::stress
