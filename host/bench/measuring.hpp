#pragma once

#include "host/bench/embree.hpp"
#include "host/kernel/gpu_scene.hpp"
#include "host/render/settings.hpp"
#include "host/vulkan/device.hpp"
#include "scene/camera/camera.hpp"
#include "scene/model/scene.hpp"

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace stromboli::bench {

// --- Measuring -----------------------------------------------------------------------------------

/// Repeated measurements of one quantity, in its unit: their median and how far they lie apart.
struct Spread {
    double median = 0;
    double least = 0, most = 0;
    double lowerQuartile = 0, upperQuartile = 0;
};

/// Quantiles by linear interpolation between order statistics (Hyndman and Fan 1996, type 7).
/// All 0 for no values.
Spread spreadOf(std::vector<double> values);

/// CPU time, user and system, of all threads of the process and of the processes that it started
/// and waited for, since the clock was made.
class CpuClock {
  public:
    CpuClock();
    double seconds() const;

  private:
    double start_;
};

/// Cuts 0 .. count-1 into blocks, which `threads` threads take one after the other; `start` is
/// called first in each of them. Returns when all is done.
void forBlocks(uint32_t threads, uint64_t count, uint64_t blockSize,
               const std::function<void()>& start,
               const std::function<void(uint64_t first, uint64_t count)>& work);

/// What one run of a contestant did.
struct Work {
    double items = 1;         ///< rays, paths, ...
    double deviceSeconds = 0; ///< by the device's own clock; 0: it has none
};

/// One of several ways to do the same work.
struct Contestant {
    std::string name;
    std::function<Work()> run;
};

/// All measurements of a contestant; entry i of each list is of round i.
struct Series {
    std::string name;
    std::vector<double> wallSeconds;   ///< per item
    std::vector<double> cpuSeconds;    ///< per item, user and system, of all threads
    std::vector<double> deviceSeconds; ///< per item; empty if the device has no clock

    /// Items per second of wall time.
    Spread wallRate() const;
    /// CPU seconds over wall seconds: the number of threads at work, on average.
    double parallelism() const;
};

struct AlternatePlan {
    uint32_t repeats = 5;
    double leastSeconds = 0.2; ///< a measurement runs its contestant again until it took that long
    std::function<void(const std::string&)> progress; ///< told what comes next; may be empty
};

/// Thrown where the user asked to stop.
struct Stopped {};

/// Runs each contestant once unmeasured (caches, first compilation), then all in turn, A B C A B C,
/// `repeats` times: what changes on the machine meanwhile (other load, clock rates) meets all of
/// them alike.
std::vector<Series> alternate(const std::vector<Contestant>& contestants,
                              const AlternatePlan& plan);

/// How many times faster `a` was than `b`: of the ratios within each round.
Spread speedup(const std::vector<double>& secondsOfA, const std::vector<double>& secondsOfB);

// --- Contestants ---------------------------------------------------------------------------------

struct BenchScene {
    std::string name;
    std::string file; ///< empty: made in memory
    Scene scene;
};

/// `name`: as readScene understands it. Throws SceneError.
BenchScene loadBenchScene(const std::string& name);

/// What all parts of the benchmark of one scene work on.
struct Arena {
    const vulkan::Device& device;
    const Embree* embree; ///< null: there is none
    uint32_t threads;
    AlternatePlan plan;
    const BenchScene& scene;
    Camera camera;
    RenderSettings settings;
};

Camera cameraOf(const BenchScene& scene, const RenderSettings& settings);

/// Embree's structures of a scene; both null without Embree.
struct EmbreePair {
    std::unique_ptr<EmbreeScene> fast, robust;
    EmbreeQuality quality = EmbreeQuality::Medium;
};

/// Builds both with the quality that traces these rays faster (by CPU time), so that Embree is at
/// its best.
EmbreePair buildBest(const Arena& arena, const RaySet& rays);

const char* nameOf(EmbreeQuality quality);

} // namespace stromboli::bench
