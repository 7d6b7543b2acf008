#pragma once

#include "host/core/log.hpp"
#include "host/render/settings.hpp"
#include "scene/camera/camera.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace stromboli {

enum class Command { Render, Check, Info, Devices };
enum class BackendChoice { Vulkan, Reference };

/// The command line, understood and checked; what needs the scene (picture size) is still open.
struct Options {
    Command command = Command::Render;
    std::string scene;
    std::string output;
    RenderSettings settings;
    bool sizeGiven = false; ///< settings.width, height
    CameraChoice camera = CameraChoice::Automatic;
    std::string device;
    BackendChoice backend = BackendChoice::Vulkan;
    double exposure = 0; ///< stops
    std::string statsFile;
    bool statisticsChannels = false; ///< EXR: sample counts and variances
    uint32_t threads = 0;            ///< host threads; 0: all
    Verbosity verbosity = Verbosity::Normal;
    double familyWiseError = 0.01; ///< check
};

/// Parses the arguments (without the program's name). Empty: help or version was printed and the
/// program is done. Throws UsageError.
std::optional<Options> parseOptions(std::vector<std::string> arguments);

} // namespace stromboli
