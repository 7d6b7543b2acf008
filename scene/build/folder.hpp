#pragma once

#include <filesystem>

namespace stromboli::build {

/// True if the file that a path and the links on it lead to lies in the folder, or below it.
bool liesBelow(const std::filesystem::path& folder, const std::filesystem::path& path);

} // namespace stromboli::build
