#include "host/cli/sequence.hpp"

#include "scene/build/picture_store.hpp"

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

#include <filesystem>
#include <regex>

namespace stromboli {
namespace {

namespace fs = std::filesystem;

/// The frame alone, as the picture's notes have it.
void nameFrame(Options& o, uint32_t frame) {
    std::erase_if(o.pictureCommand,
                  [](const std::string& p) { return p.starts_with("--frames "); });
    o.pictureCommand.push_back(fmt::format("--frames {0}..{0}", frame));
}

Options optionsOf(const Options& asked, uint32_t frame) {
    Options o = asked;
    const SequenceOptions& sequence = asked.sequence;
    o.sequence = {};
    o.output = fileOfFrame(asked.output, frame);
    if (!asked.statsFile.empty()) o.statsFile = fileOfFrame(asked.statsFile, frame);
    if (!asked.checkpointFile.empty() && asked.checkpointFile != "off")
        o.checkpointFile = fileOfFrame(asked.checkpointFile, frame);
    if (sequence.turntable > 0)
        o.camera.turn = 2 * glm::pi<double>() * frame / sequence.turntable;
    else
        o.reading.selection.seconds = frame / sequence.framesPerSecond,
        o.reading.selection.isFrame = true;
    nameFrame(o, frame);
    return o;
}

} // namespace

std::string fileOfFrame(const std::string& file, uint32_t frame) {
    static const std::regex kPattern("%(0([1-9]))?d");
    const fs::path path(file);
    const std::string name = path.filename().string();
    std::smatch found;
    std::string named;
    if (std::regex_search(name, found, kPattern)) {
        const int digits = found[2].matched ? std::stoi(found[2]) : 1;
        named = found.prefix().str() + fmt::format("{:0{}}", frame, digits) + found.suffix().str();
    } else {
        named = fmt::format("{}.{:04}{}", path.stem().string(), frame, path.extension().string());
    }
    return (path.parent_path() / named).string();
}

FrameRange readFrames(const std::string& option, const std::string& word) {
    const auto number = [&](const std::string& text) {
        return readNumber(option, text, kFrameNumbers);
    };
    const size_t dots = word.find("..");
    if (dots == std::string::npos) return {number(word), number(word)};
    const FrameRange range{number(word.substr(0, dots)), number(word.substr(dots + 2))};
    if (range.first > range.last) refuse(option, word, "the first frame and the last, as 0..59");
    return range;
}

std::vector<Options> optionsOfFrames(const Options& asked) {
    const SequenceOptions& sequence = asked.sequence;
    const FrameRange all{0, sequence.turntable > 0 ? sequence.turntable - 1 : 0};
    const FrameRange frames = sequence.frames.value_or(all);
    std::vector<Options> pictures;
    // The file is read again for each moment of its animation.
    const bool isReadAgain = sequence.turntable == 0 && frames.last > frames.first;
    const auto decoded = isReadAgain ? std::make_shared<build::PictureStore>() : nullptr;
    for (uint32_t frame = frames.first; frame <= frames.last; ++frame)
        pictures.push_back(optionsOf(asked, frame)), pictures.back().reading.pictures = decoded;
    return pictures;
}

} // namespace stromboli
