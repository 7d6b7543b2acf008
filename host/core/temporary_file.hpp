#pragma once

#include "host/core/atomic_file.hpp"

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>

namespace stromboli {

/// A new file in the folder of `path`, locked (flock) for as long as it is one, and removed again
/// unless it takes the name of `path`. Files that killed processes have left beside `path` are
/// removed when a new one is made: those that nobody holds the lock of. Throws OutputError.
class TemporaryFile {
  public:
    explicit TemporaryFile(const std::filesystem::path& path);
    ~TemporaryFile();
    TemporaryFile(const TemporaryFile&) = delete;
    TemporaryFile& operator=(const TemporaryFile&) = delete;

    void write(std::span<const std::byte> bytes);
    /// Takes the name of `path`, in place of a file that is there.
    void rename(Sync sync);

    const std::filesystem::path& name() const { return temporary_; }

  private:
    std::filesystem::path path_, temporary_;
    int descriptor_ = -1;
    bool renamed_ = false;
};

/// Removes all temporary files of this process and keeps every thread from making another one, or
/// giving one its name: for a process that ends now, whatever its threads are doing.
void removeTemporaryFilesForGood();

/// Throws the OutputError that `path` cannot be written, for this reason.
[[noreturn]] void failToWrite(const std::filesystem::path& path, const std::string& reason);
/// The same for an error number of the system.
[[noreturn]] void failToWrite(const std::filesystem::path& path, int error);

/// The folder that a file of this name is in.
std::filesystem::path folderOf(const std::filesystem::path& path);

} // namespace stromboli
