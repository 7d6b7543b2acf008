#pragma once

#include "host/cli/bench_options.hpp"
#include "host/cli/options.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace stromboli {

/// What is parsed as text or lists before it is checked.
struct RawOptions {
    std::vector<uint32_t> size, crop, cell, pixel;
    std::vector<double> adaptive;
    std::optional<double> noise, seconds;
    std::string roulette, integrator = "path", direct = "mis", camera = "auto", backend = "vulkan",
                          sampler, lightChoice = "tree", guide = "on";
    std::optional<uint32_t> sample, samples, lightSamples, maxBounces, minBounce, accumulate,
        branches;
    bool hemisphere = false, even = false, quiet = false, verbose = false;
    RawBenchOptions bench;
    RawStudyOptions study;
};

struct Subcommands {
    CLI::App* render;
    CLI::App* check;
    CLI::App* info;
    CLI::App* devices;
    CLI::App* bench;
    CLI::App* compare;
    CLI::App* study;
    CLI::App* stress;
};

/// Declares every command and option with its help; parsing fills `raw` and `options`.
Subcommands declareOptions(CLI::App& app, RawOptions& raw, Options& options);

} // namespace stromboli
