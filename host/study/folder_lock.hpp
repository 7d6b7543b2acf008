#pragma once

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

} // namespace stromboli::study
