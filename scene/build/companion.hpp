#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace stromboli::build {

/// A file that another one names.
struct Companion {
    std::optional<std::filesystem::path> path; ///< nothing: there is none in the folder or below
    std::string problem, reading;              ///< where the name had to be read otherwise
};

/// The file that a name in a file of `folder` stands for, in the folder or below; no other file is
/// ever named. Files come from machines with other rules: backslashes stand for slashes, a name
/// with other capitals for the file that there is, and a path that leads nowhere for the file of
/// the same name in the folder. Names may have the codes of a URI, or be in Latin-1. Who converts
/// the pictures of a scene seldom changes their names in it: where there is none of this name, one
/// whose name has another ending is taken.
Companion companion(const std::filesystem::path& folder, std::string_view name);
/// Reads a name likewise that is known to be a picture's, whatever its ending.
Companion pictureCompanion(const std::filesystem::path& folder, std::string_view name);

} // namespace stromboli::build
