// Several pictures by one command: frames of a film, or what several cameras see.
#include "host/cli/sequence.hpp"

#include "host/checkpoint/checkpoint_file.hpp"
#include "host/core/error.hpp"
#include "scene/build/file_store.hpp"

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <functional>
#include <memory>
#include <numeric>
#include <regex>

namespace stromboli {
namespace {

namespace fs = std::filesystem;

/// Gives all files of a picture names of their own.
void renameFiles(RenderOptions& o, const std::function<std::string(const std::string&)>& nameOf) {
    o.output.file = nameOf(o.output.file);
    if (!o.output.statsFile.empty()) o.output.statsFile = nameOf(o.output.statsFile);
    if (!o.checkpoint.file.empty() && o.checkpoint.file != "off")
        o.checkpoint.file = nameOf(o.checkpoint.file);
}

RenderOptions optionsOfFrame(const RenderOptions& asked, uint32_t frame) {
    RenderOptions o = asked;
    const SequenceOptions& sequence = asked.sequence;
    o.sequence = {};
    renameFiles(o, [&](const std::string& file) { return fileOfFrame(file, frame); });
    takeFrame(o, sequence, frame);
    nameFrame(o.command, frame);
    return o;
}

std::string inLowerCase(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

/// Whether a name has letters and digits of ASCII, - and _ alone, and is no number: numbers are for
/// cameras without a plain name.
bool isPlain(const std::string& name) {
    const auto isDigit = [](unsigned char c) { return c >= '0' && c <= '9'; };
    return !std::ranges::all_of(name, isDigit) && std::ranges::all_of(name, [](unsigned char c) {
        return c < 128 && (std::isalnum(c) || c == '-' || c == '_');
    });
}

/// What the files of a camera's picture are told apart by: its name, if it is fit for that and no
/// other camera has it, in any case of letters; else its number.
std::string wordFor(const std::vector<FileCamera>& cameras, size_t camera) {
    const std::string name = inLowerCase(cameras[camera].name);
    const auto same = std::ranges::count_if(
        cameras, [&](const FileCamera& other) { return inLowerCase(other.name) == name; });
    return same == 1 && isPlain(name) ? cameras[camera].name : std::to_string(camera + 1);
}

/// "out.png" of "left": "out.left.png".
std::string fileFor(const std::string& file, const std::string& word) {
    const fs::path path(file);
    return (path.parent_path() / (path.stem().string() + "." + word + path.extension().string()))
        .string();
}

std::vector<size_t> camerasMeant(const RenderOptions& asked, const Scene& scene) {
    std::vector<size_t> cameras;
    if (asked.cameras == std::vector<std::string>{"all"}) {
        if (scene.cameras.empty())
            throw SceneError(scene.file + ": has no camera; use --camera frame");
        cameras.resize(scene.cameras.size());
        std::iota(cameras.begin(), cameras.end(), size_t(0));
        return cameras;
    }
    for (const std::string& name : asked.cameras) {
        const size_t camera =
            *chosenCamera(scene, {CameraChoice::File, name}, asked.picture.framing);
        if (std::ranges::count(cameras, camera) > 0)
            throw UsageError(fmt::format("--camera names camera {} '{}' twice", camera + 1,
                                         scene.cameras[camera].name));
        cameras.push_back(camera);
    }
    return cameras;
}

RenderOptions optionsOfCamera(const RenderOptions& asked, const Scene& scene, size_t camera) {
    RenderOptions o = asked;
    o.picture.camera.choice = CameraChoice::File;
    o.picture.camera.name.clear();
    o.picture.camera.place = camera;
    o.cameras.clear();
    const std::string word = wordFor(scene.cameras, camera);
    renameFiles(o, [&](const std::string& file) { return fileFor(file, word); });
    // The picture is the one of this camera alone, and says so.
    for (std::string& part : o.command)
        if (part.starts_with("--camera ")) part = fmt::format("--camera {}", camera + 1);
    return o;
}

} // namespace

std::vector<uint32_t> framesOf(const SequenceOptions& sequence) {
    const FrameRange all{0, sequence.turntable > 0 ? sequence.turntable - 1 : 0};
    const FrameRange range = sequence.frames.value_or(all);
    std::vector<uint32_t> frames(range.last - range.first + 1);
    std::iota(frames.begin(), frames.end(), range.first);
    return frames;
}

void takeFrame(SceneAndPicture& work, const SequenceOptions& sequence, uint32_t frame) {
    FileSelection& selection = work.scene.reading.selection;
    if (sequence.turntable > 0) {
        work.picture.camera.turn = 2 * glm::pi<double>() * frame / sequence.turntable;
        work.picture.camera.isOneOfTurns = true;
    } else {
        selection.seconds = frame / sequence.framesPerSecond;
        selection.isFrame = true;
    }
}

void nameFrame(std::vector<std::string>& command, uint32_t frame) {
    const std::string part = fmt::format("--frames {0}..{0}", frame);
    const auto startsWith = [&](const char* name) {
        return std::ranges::find_if(command, [&](const auto& p) { return p.starts_with(name); });
    };
    if (const auto given = startsWith("--frames "); given != command.end())
        *given = part;
    else if (const auto turns = startsWith("--turntable "); turns != command.end())
        command.insert(turns + 1, part); // where --help has it
}

void checkFrames(const SequenceOptions& sequence, const SceneRequest& scene) {
    if (sequence.turntable > 0 && sequence.frames && sequence.frames->last >= sequence.turntable)
        throw UsageError(
            fmt::format("--frames: the turntable has the frames 0 to {}", sequence.turntable - 1));
    if (sequence.isGiven() && sequence.turntable == 0 && scene.reading.selection.seconds)
        throw UsageError("--at is one moment, --frames are many");
}

bool hasCheckpoint(const std::string& checkpoint) {
    return !checkpoint.empty() && (fs::exists(checkpoint) || bandsKept(checkpoint) > 0);
}

bool isFinishedPicture(const std::string& picture, const std::string& checkpoint) {
    return fs::is_regular_file(picture) && !hasCheckpoint(checkpoint);
}

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
    size_t between = std::string::npos, length = 0;
    for (const std::string_view mark : {"..", "-", ":"})
        if (between == std::string::npos) between = word.find(mark), length = mark.size();
    if (between == std::string::npos) return {number(word), number(word)};
    const FrameRange range{number(word.substr(0, between)), number(word.substr(between + length))};
    if (range.first > range.last) refuse(option, word, "the first frame and the last, as 0..59");
    return range;
}

std::vector<RenderOptions> optionsOfFrames(const RenderOptions& asked) {
    const SequenceOptions& sequence = asked.sequence;
    const std::vector<uint32_t> frames = framesOf(sequence);
    std::vector<RenderOptions> pictures;
    // The file is read once for all moments of its animation.
    const bool hasMoments = sequence.turntable == 0 && frames.size() > 1;
    const auto kept = hasMoments ? std::make_shared<build::FileStore>() : nullptr;
    for (const uint32_t frame : frames) {
        pictures.push_back(optionsOfFrame(asked, frame));
        pictures.back().scene.reading.kept = kept;
    }
    return pictures;
}

std::vector<RenderOptions> optionsOfCameras(const RenderOptions& asked, const Scene& scene) {
    // A camera whose own name has a comma is one.
    const std::string& name = asked.picture.camera.name;
    const bool isOneName =
        std::ranges::any_of(scene.cameras, [&](const FileCamera& c) { return c.name == name; });
    if (asked.cameras.empty() || (isOneName && name != "all")) return {asked};
    std::vector<RenderOptions> all;
    for (const size_t camera : camerasMeant(asked, scene))
        all.push_back(optionsOfCamera(asked, scene, camera));
    return all;
}

} // namespace stromboli
