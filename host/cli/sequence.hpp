#pragma once

#include "host/cli/declared_command.hpp"
#include "host/cli/options.hpp"
#include "scene/model/scene.hpp"

#include <string>
#include <vector>

namespace stromboli {

/// Numbers of frames.
inline constexpr Range<uint32_t> kFrameNumbers{0, 999'999};

/// The frames that a sequence asks for.
std::vector<uint32_t> framesOf(const SequenceOptions& sequence);
/// Makes the work that of one frame.
void takeFrame(SceneAndPicture& work, const SequenceOptions& sequence, uint32_t frame);
/// A command with that frame alone, as the picture's notes have it.
void nameFrame(std::vector<std::string>& command, uint32_t frame);
/// Throws UsageError if these are no frames of the sequence, or `scene` is of one moment.
void checkFrames(const SequenceOptions& sequence, const SceneRequest& scene);

/// Whether a picture is there, and no checkpoint says that it is not finished. checkpoint: its
/// file; empty: there is none.
bool isFinishedPicture(const std::string& picture, const std::string& checkpoint);
bool hasCheckpoint(const std::string& checkpoint);

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
