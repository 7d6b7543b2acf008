#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace stromboli::test {

/// Exit codes, stated here a second time so that a change of the program's is noticed.
inline constexpr int kUsage = 1, kScene = 2, kDevice = 3, kOutput = 4, kNothingLeft = 7;

/// What a run of the program left behind.
struct ProgramRun {
    int exitCode = -1; ///< 128 + n if signal n ended it
    std::string out;   ///< standard output
    std::string err;   ///< standard error
};

/// Runs the program with the Vulkan validation layer on; `environment` is put before the command,
/// as in a shell ("A=1"), and `redirection` behind it (">/dev/full").
ProgramRun stromboli(const std::vector<std::string>& arguments, const std::string& environment = "",
                     const std::string& redirection = "");

/// A folder of its own for each test, removed at the end.
class ScratchFolder {
  public:
    ScratchFolder();
    ~ScratchFolder();
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    const std::filesystem::path& path() const { return path_; }
    std::string file(const std::string& name) const { return (path_ / name).string(); }
    std::string write(const std::string& name, const std::string& text) const;
    /// Names of all there is in the folder.
    std::vector<std::string> entries() const;

  private:
    std::filesystem::path path_;
};

/// Empty if there is no such file.
std::string bytesOf(const std::filesystem::path& path);

/// A scene of scene/library.
std::string libraryScene(const std::string& name);

} // namespace stromboli::test
