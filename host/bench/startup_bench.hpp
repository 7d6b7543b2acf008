#pragma once

#include "host/bench/measuring.hpp"
#include "host/bench/report.hpp"
#include "host/vulkan/device.hpp"

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

/// How long the program takes from its start to a picture: `render` of 64 x 64 pixels, one sample,
/// whole processes; once with empty caches (the driver's of shaders, ours of pipelines), once with
/// those the run before left. sceneFile: a file. Throws DeviceError if a run fails.
StartupReport benchStartup(const std::string& program, const std::string& sceneFile,
                           const std::string& device, const AlternatePlan& plan);

/// The stages of a start, in this process, which should have done nothing before. What
/// `stromboli bench --probe-startup` does.
StartupReport::Stages probeStartup(const std::string& sceneFile, const std::string& device);

/// One line of text, and back.
std::string toText(const StartupReport::Stages& stages);
StartupReport::Stages stagesFrom(const std::string& text);

/// To the device's memory and back, as renders do it (through a staging buffer where that memory
/// is not the host's).
TransferReport benchTransfer(const vulkan::Device& device, const AlternatePlan& plan);

} // namespace stromboli::bench
