#pragma once

#include "host/bench/report.hpp"
#include "host/render/settings.hpp"

#include <functional>
#include <set>
#include <string>
#include <vector>

namespace stromboli::bench {

/// Parts of a benchmark.
enum class Part { Bvh, Rays, Paths, Variants, Robustness, Startup, Transfer };
inline constexpr Part kAllParts[] = {Part::Bvh,        Part::Rays,    Part::Paths,   Part::Variants,
                                     Part::Robustness, Part::Startup, Part::Transfer};
const char* nameOf(Part part);

/// What to measure and how long.
struct BenchSettings {
    std::vector<std::string> scenes = {"cornell_boxes", "cornell_mesh",
                                       "generate:cornell_mesh:1000000"};
    std::set<Part> parts{std::begin(kAllParts), std::end(kAllParts)};
    std::vector<uint64_t> sizes; ///< triangles of the growing scene; empty: no such part
    uint32_t width = 512, height = 512;
    uint32_t samplesPerPixel = 8, maxBounces = 5;
    uint32_t raysPerPixel = 0; ///< in ray sets; 0: what fills the device
    uint32_t repeats = 5;
    double leastSeconds = 0.2; ///< of a measurement of builds and rays
    uint32_t seed = 0;
    Sampler sampler = Sampler::Sobol;
    uint32_t threads = 0; ///< 0: as many as the device has, if it is a CPU; else all cores
    std::string device;
    std::string program;     ///< the file to start for start-up times
    std::string commandLine; ///< for the report
};

/// Does all of it. `progress` is told what is being measured, and may throw Stopped. Throws
/// Error.
BenchReport runBench(const BenchSettings& settings,
                     const std::function<void(const std::string&)>& progress);

} // namespace stromboli::bench
