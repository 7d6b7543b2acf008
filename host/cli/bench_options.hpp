#pragma once

#include "host/bench/bench.hpp"

#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace stromboli {

struct Options;
struct RawOptions;

/// What `bench` parses as text or lists before it is checked.
struct RawBenchOptions {
    std::vector<std::string> scenes, parts;
    std::string sizes;
    std::optional<uint32_t> repeats, raysPerPixel;
    bool quick = false, probeStartup = false;
};

/// `bench` as understood: what the other commands have too is in Options.
struct BenchOptions {
    bench::BenchSettings settings;
    std::string jsonFile;      ///< empty: none
    bool probeStartup = false; ///< time the stages of this process's start, and no more
};

/// Declares what only `bench` has.
void declareBench(CLI::App& app, RawBenchOptions& raw, BenchOptions& options);

/// Fills in what the user left to `bench`: quick runs have smaller pictures and fewer samples.
void applyBenchDefaults(RawOptions& raw);

/// Throws UsageError.
void applyBench(const RawBenchOptions& raw, Options& options);

} // namespace stromboli
