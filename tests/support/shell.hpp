#pragma once

#include <filesystem>
#include <string>

namespace stromboli::test {

struct ShellRun {
    int exitCode = -1;
    std::string output; ///< standard output and standard error
};

/// Runs a command line of bash.
ShellRun shell(const std::string& commands);

/// True where a program of that name is on the path.
bool isInstalled(const std::string& program);

/// A new, empty folder; removed with this object.
class EmptyFolder {
  public:
    EmptyFolder();
    ~EmptyFolder();
    EmptyFolder(const EmptyFolder&) = delete;
    EmptyFolder& operator=(const EmptyFolder&) = delete;
    const std::filesystem::path& path() const { return path_; }
    std::string operator/(const std::string& name) const { return (path_ / name).string(); }

  private:
    std::filesystem::path path_;
};

} // namespace stromboli::test
