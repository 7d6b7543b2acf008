#pragma once

#include "host/core/json.hpp"
#include "host/study/study.hpp"
#include "host/study/summary.hpp"

#include <filesystem>

namespace stromboli::study {

/// All of a study, measurements and what follows from them, as written to study.json.
Json toJson(const Study& study);

/// The measurements of a study.json with the same key: scene by scene, runs of configurations
/// whose options are the same and whose efforts are those of `study` (as many as its settings
/// have, or cut short). They go to `study`; returns how many. 0 if there is no such file or it is
/// of another key. Throws OutputError if the file is there and is not a study.
size_t takeOver(const std::filesystem::path& file, Study& study);

/// A line for each picture measured, with a head.
std::string toCsv(const Study& study);

/// For people: a table for each scene.
std::string toText(const Study& study);

} // namespace stromboli::study
