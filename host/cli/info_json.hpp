#pragma once

#include "host/cli/job.hpp"
#include "host/core/json.hpp"

namespace stromboli {

/// All that `info` says of a scene, for programs.
Json infoJson(const Job& job, const BuiltScene& built);

} // namespace stromboli
