#include "host/bench/alternate.hpp"

#include "host/bench/cpu_clock.hpp"
#include "host/core/stopwatch.hpp"

#include <numeric>

namespace stromboli::bench {
namespace {

std::vector<double> inverse(std::vector<double> values) {
    for (double& v : values)
        v = 1 / v;
    return values;
}

void measure(const Contestant& contestant, double leastSeconds, Series& series) {
    const CpuClock cpu;
    const Stopwatch wall;
    Work work{0, 0};
    do {
        const Work w = contestant.run();
        work.items += w.items;
        work.deviceSeconds += w.deviceSeconds;
    } while (wall.seconds() < leastSeconds);
    series.wallSeconds.push_back(wall.seconds() / work.items);
    series.cpuSeconds.push_back(cpu.seconds() / work.items);
    if (work.deviceSeconds > 0) series.deviceSeconds.push_back(work.deviceSeconds / work.items);
}

} // namespace

Spread Series::wallRate() const {
    return spreadOf(inverse(wallSeconds));
}

double Series::parallelism() const {
    return std::accumulate(cpuSeconds.begin(), cpuSeconds.end(), 0.0) /
           std::accumulate(wallSeconds.begin(), wallSeconds.end(), 0.0);
}

std::vector<Series> alternate(const std::vector<Contestant>& contestants,
                              const AlternatePlan& plan) {
    const auto tell = [&](const std::string& what) {
        if (plan.progress) plan.progress(what);
    };
    std::vector<Series> all;
    for (const Contestant& c : contestants) {
        tell(c.name + ", warming up");
        c.run();
        all.emplace_back().name = c.name;
    }
    for (uint32_t round = 0; round < plan.repeats; ++round)
        for (size_t i = 0; i < contestants.size(); ++i) {
            tell(contestants[i].name + ", round " + std::to_string(round + 1) + " of " +
                 std::to_string(plan.repeats));
            measure(contestants[i], plan.leastSeconds, all[i]);
        }
    return all;
}

Spread speedup(const std::vector<double>& secondsOfA, const std::vector<double>& secondsOfB) {
    std::vector<double> ratios;
    for (size_t i = 0; i < secondsOfA.size() && i < secondsOfB.size(); ++i)
        ratios.push_back(secondsOfB[i] / secondsOfA[i]);
    return spreadOf(ratios);
}

} // namespace stromboli::bench
