#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace stromboli {

/// What only `stress` is told.
struct StressOptions {
    std::vector<std::string> cases; ///< names, or numbers of docs/hard_cases.md; empty: all
    bool list = false, full = false;
    std::string jsonFile; ///< empty: none
};

void declareStress(CLI::App& app, StressOptions& options);

} // namespace stromboli
