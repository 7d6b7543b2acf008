#pragma once

#include "host/bench/report.hpp"
#include "host/core/messages.hpp"
#include "host/core/text.hpp"
#include "host/render/settings.hpp"

#include <functional>
#include <set>
#include <string>
#include <vector>

namespace stromboli {
namespace bench {

/// Parts of a benchmark.
enum class Part { Bvh, Rays, Paths, Variants, Textures, Startup, Transfer };
} // namespace bench

template <>
inline constexpr auto kNamedValues<bench::Part> = std::to_array<NamedValue<bench::Part>>({
    {bench::Part::Bvh, "bvh", "building and quality of the tree"},
    {bench::Part::Rays, "rays", "rays alone"},
    {bench::Part::Paths, "paths", "whole paths"},
    {bench::Part::Variants, "variants", "kernels with everything on, or other tunings"},
    {bench::Part::Textures, "textures", "what they cost, where the scene has some"},
    {bench::Part::Startup, "startup", "a small render, the whole process"},
    {bench::Part::Transfer, "transfer", "to and from the device"},
});

namespace bench {

std::set<Part> allParts();

/// What to measure and how long.
struct BenchSettings {
    std::vector<std::string> scenes = {"reading_room", "door_ajar", "bathroom", "atrium"};
    std::set<Part> parts = allParts();
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
    Messages messages;       ///< of the device
};

/// Does all of it. `progress` is told what is being measured, and may throw Stopped. Throws
/// Error.
BenchReport runBench(const BenchSettings& settings,
                     const std::function<void(const std::string&)>& progress);

} // namespace bench
} // namespace stromboli
