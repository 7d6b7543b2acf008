#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>

namespace stromboli {

/// How far a film has come that is still being written under its name, as by a program that copies
/// it; Stromboli gives films their name when they are complete.
struct UnfinishedFilm {
    uint32_t rows = 0;    ///< that are complete, from the top
    uint32_t allRows = 0; ///< 0: its header is not complete
};
/// "is still being written: 12 of 90 rows are complete".
std::string inWords(const UnfinishedFilm& film);
/// Empty: the file is complete, or is no film's beginning.
std::optional<UnfinishedFilm> unfinishedFilm(const std::filesystem::path& path);

} // namespace stromboli
