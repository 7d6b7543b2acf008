#pragma once

#include "host/farm/round_plan.hpp"

#include <filesystem>

namespace stromboli {

/// Whether a name ends as that of a plan does: .plan.
bool namesPlan(const std::filesystem::path& path);

/// Replaces the file whole. Throws OutputError.
void writePlan(const std::filesystem::path& file, const RoundPlan& plan);
/// Throws UsageError that names the file if it is none, of another version, damaged or cut short.
RoundPlan readPlan(const std::filesystem::path& file);

} // namespace stromboli
