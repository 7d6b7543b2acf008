#pragma once

#include "host/compare/comparison.hpp"

#include <string>

namespace CLI {
class App;
}

namespace stromboli {

/// `compare` as understood.
struct CompareOptions {
    std::string reference, picture;
    compare::CompareSettings settings;
    compare::Thresholds thresholds;
    std::string jsonFile;       ///< empty: none; "-": standard output, instead of the text
    std::string differenceFile; ///< empty: none
    std::string show = "flip";  ///< what a PNG of the difference holds: flip, relative, signed
};

void declareCompare(CLI::App& app, CompareOptions& options);

/// Throws UsageError: output files that name an input, an unknown kind of picture.
void checkCompare(const CompareOptions& options);

} // namespace stromboli
