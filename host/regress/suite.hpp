#pragma once

#include "host/compare/comparison.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace stromboli::regress {

/// A picture of a suite, with what holds for it of what the suite says for all.
struct SuitePicture {
    std::string name;  ///< of the golden picture's file, and in reports
    std::string scene; ///< as `render` takes it; a file, relative to the suite's folder, is found
    uint32_t width = 160, height = 120;
    uint32_t samples = 64;            ///< of a pixel
    uint32_t goldenSamples = 256;     ///< those that --update gives the golden picture
    std::vector<std::string> options; ///< further ones of `render`
    std::filesystem::path golden;     ///< EXR with variances, or whatever `compare` reads
    compare::Thresholds limits;       ///< beside the statistical test, or in place of it
    // Budgets: what is over one is said and fails nothing.
    std::optional<double> seconds, megabytes;
    int line = 0; ///< of the suite's file
};

/// What a file of `stromboli regress` says.
struct Suite {
    std::filesystem::path file;
    /// The probability that a suite of right pictures fails, all its statistical tests together.
    double falseAlarms = 0.01;
    std::vector<SuitePicture> pictures;
};

/// Reads a suite (docs/guide/regress.md). Throws SceneError with file, line and what was expected.
Suite readSuite(const std::filesystem::path& file);

/// The suite's pictures of these names, in its order; all if there are none. Throws UsageError for
/// a name that no picture has.
std::vector<SuitePicture> chosen(const Suite& suite, const std::vector<std::string>& names);

} // namespace stromboli::regress
