// The kernel's random numbers.
#include "host/core/random.hpp"
#include "host/stress/case.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace stromboli::stress {
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

/// Of n pairs of uniform numbers; its standard deviation is n^-1/2.
double correlation(const std::vector<RandomBlock>& a, size_t i, const std::vector<RandomBlock>& b,
                   size_t k) {
    double sum = 0;
    for (size_t n = 0; n < a.size(); ++n)
        sum += (a[n].numbers[i] - 0.5) * (b[n].numbers[k] - 0.5);
    return 12 * sum / double(a.size());
}

/// Of numbers with those of the next pixel, row, sample, use and seed: 1e6 pairs, so that the bound
/// of 0.01 is ten standard deviations.
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

} // namespace stromboli::stress
