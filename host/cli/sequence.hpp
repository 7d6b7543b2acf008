#pragma once

#include "host/cli/declared_command.hpp"
#include "host/cli/options.hpp"
#include "scene/model/scene.hpp"

#include <string>
#include <vector>

namespace stromboli {

/// Numbers of frames.
inline constexpr Range<uint32_t> kFrameNumbers{0, 999'999};

/// The options of each picture of a sequence (RenderOptions::sequence), with files of its own.
std::vector<RenderOptions> optionsOfFrames(const RenderOptions& asked);

/// The options of each camera's picture (RenderOptions::cameras), with files of its own.
std::vector<RenderOptions> optionsOfCameras(const RenderOptions& asked, const Scene& scene);

/// The file of a frame: a pattern as ffmpeg has it ("a%04d.png") with the number in it; else the
/// number, of four digits or more, before the ending ("a.png": "a.0007.png").
std::string fileOfFrame(const std::string& file, uint32_t frame);

/// Reads "A..B", "A-B" or "A:B", whole numbers with A not above B, or one number. Throws
/// UsageError.
FrameRange readFrames(const std::string& option, const std::string& word);

} // namespace stromboli
