#pragma once

#include "host/study/study.hpp"

#include <string>

namespace stromboli {

/// `study` as understood.
struct StudyOptions {
    study::StudySettings settings;
    std::string folder = "study";
    bool list = false; ///< print the known configurations and no more
};

} // namespace stromboli
