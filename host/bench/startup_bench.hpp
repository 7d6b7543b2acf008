#pragma once

#include "host/bench/alternate.hpp"
#include "host/bench/report.hpp"

#include <string>

namespace stromboli::bench {

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

} // namespace stromboli::bench
