#pragma once

#include "host/study/study.hpp"

#include <optional>
#include <string>
#include <vector>

namespace CLI {
class App;
}

namespace stromboli {

/// What `study` parses as text or lists before it is checked.
struct RawStudyOptions {
    std::vector<std::string> scenes, configurations;
    std::vector<uint32_t> size, sampleCounts;
    std::string moreOptions;
    std::optional<uint32_t> maxBounces, seeds, referenceSamples, targetSamples;
    bool quick = false;
};

/// `study` as understood.
struct StudyOptions {
    study::StudySettings settings;
    std::string folder = "study";
    bool list = false; ///< print the known configurations and no more
};

void declareStudy(CLI::App& app, RawStudyOptions& raw, StudyOptions& options);

/// Throws UsageError.
void applyStudy(const RawStudyOptions& raw, StudyOptions& options);

} // namespace stromboli
