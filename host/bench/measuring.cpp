#include "host/bench/measuring.hpp"

#include "host/core/system.hpp"
#include "host/engine/load_scene.hpp"
#include "scene/find_scene.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <numeric>
#include <sys/resource.h>
#include <thread>

namespace stromboli::bench {

// --- Measuring -----------------------------------------------------------------------------------

namespace {

double quantile(const std::vector<double>& sorted, double fraction) {
    const double at = fraction * double(sorted.size() - 1);
    const auto below = size_t(std::floor(at));
    const size_t above = std::min(below + 1, sorted.size() - 1);
    return std::lerp(sorted[below], sorted[above], at - double(below));
}

} // namespace

Spread spreadOf(std::vector<double> values) {
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    return {quantile(values, 0.5), values.front(), values.back(), quantile(values, 0.25),
            quantile(values, 0.75)};
}

namespace {

double secondsOf(int who) {
    rusage usage{};
    getrusage(who, &usage);
    const auto seconds = [](const timeval& t) {
        return double(t.tv_sec) + 1e-6 * double(t.tv_usec);
    };
    return seconds(usage.ru_utime) + seconds(usage.ru_stime);
}

double now() {
    return secondsOf(RUSAGE_SELF) + secondsOf(RUSAGE_CHILDREN);
}

} // namespace

CpuClock::CpuClock() : start_(now()) {}

double CpuClock::seconds() const {
    return now() - start_;
}

void forBlocks(uint32_t threads, uint64_t count, uint64_t blockSize,
               const std::function<void()>& start,
               const std::function<void(uint64_t first, uint64_t count)>& work) {
    std::atomic<uint64_t> next{0};
    const auto takeBlocks = [&] {
        start();
        for (uint64_t first; (first = next.fetch_add(blockSize)) < count;)
            work(first, std::min(blockSize, count - first));
    };
    std::vector<std::jthread> workers;
    for (uint32_t i = 0; i < threads; ++i)
        workers.emplace_back(takeBlocks);
}

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

// --- Contestants ---------------------------------------------------------------------------------

BenchScene loadBenchScene(const std::string& name) {
    return {name, sceneFile(name), std::move(*loadScene({name, {}, {}}).scene)};
}

const char* nameOf(EmbreeQuality quality) {
    return quality == EmbreeQuality::High ? "high" : "medium";
}

Camera cameraOf(const BenchScene& scene, const RenderSettings& settings) {
    return makeCamera(scene.scene, CameraChoice::Automatic, settings.area.width,
                      settings.area.height);
}

EmbreePair buildBest(const Arena& arena, const RaySet& rays) {
    if (!arena.embree) return {};
    const auto geometry = arena.embree->geometry(arena.scene.scene);
    const auto build = [&](EmbreeMode mode, EmbreeQuality quality) {
        return arena.embree->build(geometry, mode, quality);
    };
    auto medium = build(EmbreeMode::Fast, EmbreeQuality::Medium);
    auto high = build(EmbreeMode::Fast, EmbreeQuality::High);
    const auto tracing = [&](const EmbreeScene& built) {
        return [&] {
            built.trace(rays);
            return Work{double(rays.rays.size()), 0};
        };
    };
    AlternatePlan plan = arena.plan;
    plan.repeats = 3;
    const std::vector<Series> trials = alternate(
        {{"Embree's medium quality", tracing(*medium)}, {"Embree's high quality", tracing(*high)}},
        plan);
    const bool highWins =
        spreadOf(trials[1].cpuSeconds).median < spreadOf(trials[0].cpuSeconds).median;
    EmbreePair pair;
    pair.quality = highWins ? EmbreeQuality::High : EmbreeQuality::Medium;
    pair.fast = std::move(highWins ? high : medium);
    medium.reset();
    high.reset();
    pair.robust = build(EmbreeMode::Robust, pair.quality);
    return pair;
}

} // namespace stromboli::bench
