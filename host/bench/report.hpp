#pragma once

#include "host/bench/embree.hpp"
#include "host/bench/measuring.hpp"
#include "host/core/json.hpp"
#include "host/vulkan/device.hpp"

#include <optional>
#include <string>
#include <vector>

namespace stromboli::bench {

// --- Reports -------------------------------------------------------------------------------------

// What `stromboli bench` found, before it is put into words. Series are in seconds for one item:
// one build, one ray, one path, one byte.

/// Where and how the figures were made.
struct Circumstances {
    std::string date; ///< UTC, ISO 8601
    std::string commandLine, version;
    std::string cpu, system;
    uint32_t cores = 0, threads = 0; ///< threads: of the BVH builders, Embree and, if it is a CPU,
                                     ///< the device
    std::string device, driver, compiler;
    bool deviceIsCpu = false;
    std::string embreeVersion, embreeFlags;
    std::string embreeMissing; ///< why the Embree columns are empty; or nothing
};

struct BvhReport {
    std::vector<Series> builds; ///< ours, Embree medium, Embree high
    Series binaryTree;          ///< the first part of ours
    double expectedVisits = 0;  ///< records on the way of a random line (SAH)
    double bytesPerPrimitive = 0;
    double embreeBytesPerPrimitive = 0; ///< 0: no Embree
};

/// One ray set, traced by every contestant.
struct RayReport {
    std::string kind;
    uint64_t rays = 0;
    double hitShare = 0;
    double nodes = 0, leaves = 0;    ///< records of either kind that a ray visits, on average
    std::vector<Series> contestants; ///< device, Embree fast, Embree robust
    /// Rays that an Embree contestant found to end elsewhere than the device did; one entry for
    /// each of them.
    std::vector<uint64_t> disagreements;
};

struct PathReport {
    double raysPerPath = 0;
    std::vector<Series> contestants; ///< device
    double driverBusy = 0; ///< share of the driver's threads at work; 0 where they are a GPU's
    double lanesBusy = 0;  ///< share of lanes at work in traversal steps
};

/// The kernel in another form, against the one that renders use.
struct VariantReport {
    std::vector<Series> contestants; ///< default, variants
    std::vector<bool> samePicture;   ///< of each variant: to the bit
};

/// The scene against the same one with means in the place of textures, by ray.
struct TextureReport {
    std::vector<Series> contestants; ///< textures, their means
    std::vector<double> raysPerPath; ///< of each
};

struct SceneReport {
    std::string name;
    uint64_t triangles = 0, spheres = 0;
    uint32_t width = 0, height = 0, samplesPerPixel = 0, maxBounces = 0;
    std::string embreeQuality; ///< the one that was the faster in tracing, used below
    std::optional<BvhReport> bvh;
    std::vector<RayReport> rays;
    std::optional<PathReport> paths;
    std::optional<VariantReport> variants;
    std::optional<TextureReport> textures; ///< none: the scene has none
};

/// One size of a growing scene.
struct GrowthPoint {
    std::string scene;
    uint64_t triangles = 0;
    double buildSeconds = 0, embreeBuildSeconds = 0;
    RayReport bounce;
};

struct StartupReport {
    std::vector<Series> wholeProcess; ///< render, 64 x 64, one sample: cold and warm caches
    struct Stages {
        double device = 0, load = 0, build = 0, pipeline = 0, firstDispatch = 0, secondDispatch = 0;
    };
    Stages cold, warm; ///< seconds, medians
};

struct TransferReport {
    uint64_t bytes = 0;
    std::vector<Series> directions; ///< upload, readback
};

struct BenchReport {
    Circumstances circumstances;
    std::vector<SceneReport> scenes;
    std::vector<GrowthPoint> growth;
    std::optional<StartupReport> startup;
    std::optional<TransferReport> transfer;
};

/// All of the report, every single measurement included; times in seconds for one item (build, ray,
/// path, byte). Comparisons are against the first contestant of a list, which is ours.
Json toJson(const BenchReport& report);

/// The report for people: lines of at most 100 characters or so. Figures are medians, with the
/// least and the most in brackets; "x" figures are medians of the ratios of each round, above 1
/// where ours is the faster.
std::string toTable(const BenchReport& report);

// --- Circumstances -------------------------------------------------------------------------------

/// Threads of a device that is a CPU (llvmpipe: LP_NUM_THREADS, at most one a core); of others 0.
uint32_t deviceThreads(const vulkan::DeviceDescription& device);

Circumstances circumstancesOf(const vulkan::DeviceDescription& device, const OpenedEmbree& embree,
                              uint32_t threads, const std::string& commandLine);

} // namespace stromboli::bench
