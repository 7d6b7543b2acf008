#pragma once

#include "host/core/json.hpp"
#include "host/study/study.hpp"
#include "host/study/summary.hpp"

#include <filesystem>

namespace stromboli::study {

/// Keeps a study's folder for one process, for as long as it lives: two that wrote to the same
/// study.json would lose each other's runs. The system lets go of the lock when the process ends,
/// however it does; the file `.lock` stays.
class FolderLock {
  public:
    /// Throws OutputError if another process has the folder, or no file can be made in it.
    explicit FolderLock(const std::filesystem::path& folder);
    ~FolderLock();
    FolderLock(const FolderLock&) = delete;
    FolderLock& operator=(const FolderLock&) = delete;

  private:
    int descriptor_;
};

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
