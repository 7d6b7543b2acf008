#pragma once

#include "scene/pbrt/statement.hpp"

#include <string>
#include <vector>

namespace stromboli::pbrt {

enum class Version { V3, V4 };

/// Which of both a scene is written for, by the words that only one of them has.
struct VersionFound {
    Version version = Version::V4;
    std::string sign; ///< the first thing that tells it; empty: nothing does
};

VersionFound versionOf(const std::vector<Statement>& statements);

} // namespace stromboli::pbrt
