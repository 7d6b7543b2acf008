#include "host/core/random.hpp"
#include "host/stress/case.hpp"
#include "host/stress/scenes.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>

namespace stromboli::stress {

// --- Arithmetic ----------------------------------------------------------------------------------

// What kernels take for granted of the device's floats (docs/theory/numerics.md): IEEE 754 as the
// host has it. Where a device promises it, kernels ask for it (host/vulkan/instance.hpp).

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

/// Whether two floats have the same bits. Any NaN agrees with a NaN, and anything with a denormal,
/// which a device may take for zero.
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

/// Signs of zeros, infinities, and numbers that are neither: rays in planes of boxes and lights
/// that fall off to nothing depend on them.
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

// --- Random numbers ------------------------------------------------------------------------------

// The kernel's random numbers.

namespace {

/// pcg4d of Jarzynski and Olano 2020, as the paper lists it.
Words hash(Words v) {
    for (uint32_t& word : v)
        word = word * 1664525u + 1013904223u;
    const auto mix = [&v] {
        v[0] += v[1] * v[3];
        v[1] += v[2] * v[0];
        v[2] += v[0] * v[1];
        v[3] += v[1] * v[2];
    };
    mix();
    for (uint32_t& word : v)
        word ^= word >> 16;
    mix();
    return v;
}

/// Counters as pictures have them, by turns with any others.
std::vector<Words> someCounters(size_t count) {
    Random random(1043);
    std::vector<Words> counters(count);
    for (size_t i = 0; i < count; ++i)
        counters[i] = i % 2 ? Words{uint32_t(i), uint32_t(i / 1000), uint32_t(i % 17), 0}
                            : Words{random.word(), random.word(), random.word(), random.word()};
    return counters;
}

Finding words(Run& run) {
    const auto counters = someCounters(run.amount<size_t>(100'000, 10'000'000));
    const auto found = run.subject().randomBlocks(counters);
    Finding f;
    f.trials = 4 * counters.size();
    for (size_t i = 0; i < counters.size(); ++i) {
        const Words expected = hash(counters[i]);
        for (size_t k = 0; k < 4; ++k) // 24 bits times a power of two: exact, and below 1
            f.measured += found[i].words[k] != expected[k] ||
                          found[i].numbers[k] != float(expected[k] >> 8) * 0x1p-24f;
    }
    return f;
}

/// The correlation of n pairs of uniform numbers; its standard deviation is n^-1/2.
double correlation(const std::vector<RandomBlock>& a, size_t i, const std::vector<RandomBlock>& b,
                   size_t k) {
    double sum = 0;
    for (size_t n = 0; n < a.size(); ++n)
        sum += (a[n].numbers[i] - 0.5) * (b[n].numbers[k] - 0.5);
    return 12 * sum / double(a.size());
}

/// Correlations of numbers with those of the next pixel, row, sample, use and seed: 1e6 pairs, so
/// that the bound of 0.01 is ten standard deviations.
Finding neighbours(Run& run) {
    Finding f;
    f.bound = 0.01;
    const auto blocks = [&](const Words& step) {
        std::vector<Words> counters(1'000'000);
        for (uint32_t i = 0; i < counters.size(); ++i)
            counters[i] = {i % 1000 + step[0], i / 1000 + step[1], i % 7 + step[2], step[3]};
        return run.subject().randomBlocks(counters);
    };
    const std::vector<std::pair<const char*, Words>> steps = {{"pixel", {1, 0, 0, 0}},
                                                              {"row", {800, 0, 0, 0}},
                                                              {"sample", {0, 1, 0, 0}},
                                                              {"use", {0, 0, 1, 0}},
                                                              {"seed", {0, 0, 0, 1}}};
    const auto base = blocks({});
    for (const auto& [name, step] : steps) {
        const auto next = blocks(step);
        for (size_t i = 0; i < 4; ++i)
            for (size_t k = 0; k < 4; ++k) {
                const double found = std::abs(correlation(base, i, next, k));
                if (found > f.measured) f.measured = found, f.where = fmt::format("next {}", name);
            }
        f.trials += base.size();
        run.goOn();
    }
    return f;
}

} // namespace

std::vector<Case> randomCases() {
    return {
        {"random-words", "43", "random numbers are the host's to the last bit, and below 1",
         "wrong", "numbers", words},
        {"random-neighbours", "43", "random numbers of neighbours are not correlated",
         "correlation", "pairs", neighbours},
    };
}

// --- Films ---------------------------------------------------------------------------------------

// Sums of many samples, samples that must be left out, and how the work is cut.

namespace {

/// Inside an emitter: every sample is its radiance.
Scene insideEmitter(const glm::vec3& radiance) {
    SceneMaker m;
    Material glow = emissive(1, true);
    glow.emission = radiance;
    m.sphere({0, 0, 0}, 1, m.add(glow));
    return m.scene;
}

const Camera kInside = lookingAt({0, 0, 0}, {0, 0, 1}, 1);

/// Powers of two would add up without rounding.
Finding manySamples(Run& run) {
    const glm::vec3 value(0.5f, 0.1f, 0.7f);
    RenderSettings s = picture(4, run.amount(200'000u, 10'000'000u), 0);
    const Film film = run.render(insideEmitter(value), kInside, s).film;
    Finding f;
    f.bound = 1e-6;
    for (const PixelStatistics& p : film.pixels) {
        f.trials += p.count;
        for (int c = 0; c < 3; ++c) {
            const double off = std::abs(p.mean[c] - double(value[c]));
            // The running mean is rounded to float where deviations from it are formed.
            const double spread = std::sqrt(p.variance()[c]) - 0x1p-23 * double(value[c]);
            const double worst =
                p.count == s.budget.mostSamplesPerPixel ? std::max(off, spread) : 1;
            if (!(worst <= f.measured)) f.measured = worst, f.where = fmt::format("{}", value[c]);
        }
    }
    return f;
}

/// A wall of nine emitters, the middle one of a radiance that is none.
Finding badSamples(Run& run) {
    Finding f;
    for (const float bad : {kNaN, -kNaN, kInfinity, -kInfinity, -1.0f, 1e38f, 0x1.000002p48f}) {
        SceneMaker m;
        const uint32_t good = m.add(emissive(0.25f, true));
        Material wrong = emissive(1, true);
        wrong.emission = {0.5f, bad, 0.5f};
        const uint32_t middle = m.add(wrong);
        for (int i = -1; i <= 1; ++i)
            for (int k = -1; k <= 1; ++k)
                m.quad({float(i) - 0.5f, float(k) - 0.5f, 0}, {1, 0, 0}, {0, 1, 0},
                       i == 0 && k == 0 ? middle : good);
        Camera camera = lookingAt({0, 0, 1}, {0, 0, 0}, 1.5);
        camera.orthographic = true;
        const RenderSettings s = picture(3 * 8, run.amount(5u, 500u), 0);
        const Film film = run.render(m.scene, camera, s).film;
        for (uint32_t y = 0; y < s.area.height; ++y)
            for (uint32_t x = 0; x < s.area.width; ++x) {
                const PixelStatistics& p = film.at(x, y);
                const bool spoilt = x / 8 == 1 && y / 8 == 1;
                const uint32_t n = s.budget.mostSamplesPerPixel;
                const bool right = spoilt ? p.count == 0 && p.rejected == n && p.firstRejected == 0
                                          : p.count == n && p.mean == glm::dvec3(0.25);
                if (right) continue;
                f.measured += 1;
                f.where = fmt::format("radiance {}", bad);
            }
        f.trials += film.pixels.size();
    }
    return f;
}

bool sameBits(const PixelStatistics& a, const PixelStatistics& b) {
    return a.count == b.count && a.rejected == b.rejected &&
           std::memcmp(&a.mean, &b.mean, sizeof a.mean) == 0 &&
           std::memcmp(&a.m2, &b.m2, sizeof a.m2) == 0;
}

/// A picture is the same to the last bit, whatever the workgroups, lanes, dispatches and ways to
/// fetch.
Finding cuts(Run& run) {
    const Scene scene = cornellBox();
    const Camera camera = lookingAt({0.5, 0.5, 0.9375}, {0.5, 0.4375, 0}, 0.75);
    RenderSettings s = picture(run.amount(24u, 128u), run.amount(8u, 64u), 6);
    s.area.width += 5; // no multiple of a tile or a workgroup
    std::vector<KernelTuning> tunings = {{.workgroupSize = 8},     {.workgroupSize = 32},
                                         {.workgroupSize = 64},    {.traversalSteps = 3},
                                         {.registerStack = 0},     {.lanes = 100},
                                         {.itemsPerDispatch = 77}, {.fixedIterations = 9}};
    for (const bool texel : {false, true})
        tunings.push_back({.texelFetch = texel});
    const Film whole = run.render(scene, camera, s).film;
    Finding f;
    for (size_t i = 0; i < tunings.size(); ++i) {
        const Film other = run.render(scene, camera, s, tunings[i]).film;
        for (size_t k = 0; k < whole.pixels.size(); ++k)
            f.measured += !sameBits(whole.pixels[k], other.pixels[k]);
        if (f.measured > 0 && f.where.empty()) f.where = fmt::format("way {} to cut", i + 1);
        f.trials += whole.pixels.size();
    }
    return f;
}

/// Pictures of shapes that fit nothing, with the fewest samples and bounces; scenes with nothing in
/// them; a camera inside an object. Every pixel has its samples, none is rejected.
Finding shapes(Run& run) {
    Finding f;
    const auto check = [&](const char* what, const Scene& scene, const Camera& camera,
                           const RenderSettings& s, bool lit) {
        for (const PixelStatistics& p : run.render(scene, camera, s).film.pixels) {
            const bool right = p.count == s.budget.mostSamplesPerPixel && p.rejected == 0 &&
                               (lit ? p.mean.x > 0 : p.mean == glm::dvec3(0.0));
            if (!right) f.measured += 1, f.where = what;
            ++f.trials;
        }
    };
    const Scene glow = insideEmitter(glm::vec3(0.5f));
    for (const auto& [width, height] :
         {std::pair{1u, 1u}, {1u, 17u}, {7u, 13u}, {run.amount(4000u, 16384u), 1u}})
        for (const uint32_t bounces : {0u, 1u}) {
            RenderSettings s = picture(1, 1, bounces);
            s.area.width = width, s.area.height = height;
            check("shape", glow, kInside, s, true);
        }
    check("empty scene", Scene{}, kInside, picture(9, 3, 5), false);
    SceneMaker dark, ball;
    dark.box({-1, -1, -1}, {1, 1, 1}, dark.add(diffuse(0.5f)), true);
    check("no lights", dark.scene, kInside, picture(9, 3, 5), false);
    ball.sphere({0, 0, 0}, 1, ball.add(glass(1.5f)));
    ball.sphere({0, 0, 0}, 10, ball.add(emissive(1, true)));
    check("camera in glass", ball.scene, kInside, picture(9, 3, 100), true);
    return f;
}

} // namespace

std::vector<Case> filmCases() {
    return {
        {"many-samples", "54", "the mean of 1e7 equal samples", "difference", "samples",
         manySamples},
        {"bad-samples", "60", "NaN, infinite, negative, huge samples are left out and counted",
         "wrong", "pixels", badSamples},
        {"cuts", "59, 63", "the same bits, however the work is cut", "different", "pixels", cuts},
        {"shapes", "65", "pictures and scenes of unusual shape", "wrong", "pixels", shapes},
    };
}

} // namespace stromboli::stress
