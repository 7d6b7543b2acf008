#pragma once

#include <filesystem>
#include <string>
#include <utility>
#include <vector>

namespace stromboli::bench {

/// An empty folder of its own under the system's temporary folder, removed with all it holds.
class ScratchFolder {
  public:
    /// Throws OutputError.
    ScratchFolder();
    ~ScratchFolder();
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

using Environment = std::vector<std::pair<std::string, std::string>>; ///< name, value

/// Runs a program to its end, with this process's environment and `changes` to it; returns what
/// it printed on standard output. Throws DeviceError, with the last line it printed on standard
/// error, if it cannot be started or fails.
std::string runProgram(const std::vector<std::string>& command, const Environment& changes);

} // namespace stromboli::bench
