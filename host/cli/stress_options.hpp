#pragma once

#include <string>
#include <vector>

namespace stromboli {

/// What only `stress` is told.
struct StressOptions {
    std::vector<std::string> cases; ///< names, or numbers of docs/hard_cases.md; empty: all
    bool list = false, full = false;
    std::string jsonFile; ///< empty: none
};

} // namespace stromboli
