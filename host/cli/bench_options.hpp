#pragma once

#include "host/bench/bench.hpp"

#include <string>

namespace stromboli {

/// `bench` as understood.
struct BenchOptions {
    bench::BenchSettings settings;
    std::string jsonFile;      ///< empty: none
    bool probeStartup = false; ///< time the stages of this process's start, and no more
};

} // namespace stromboli
