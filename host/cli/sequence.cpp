// Several pictures by one command: frames of a film, or what several cameras see.
#include "host/cli/sequence.hpp"

#include "host/core/error.hpp"
#include "scene/build/picture_store.hpp"

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

/// The frame alone, as the picture's notes have it.
void nameFrame(std::vector<std::string>& command, uint32_t frame) {
    std::erase_if(command, [](const std::string& p) { return p.starts_with("--frames "); });
    command.push_back(fmt::format("--frames {0}..{0}", frame));
}

RenderOptions optionsOfFrame(const RenderOptions& asked, uint32_t frame) {
    RenderOptions o = asked;
    const SequenceOptions& sequence = asked.sequence;
    o.sequence = {};
    renameFiles(o, [&](const std::string& file) { return fileOfFrame(file, frame); });
    FileSelection& selection = o.scene.reading.selection;
    if (sequence.turntable > 0)
        o.picture.camera.turn = 2 * glm::pi<double>() * frame / sequence.turntable;
    else
        selection.seconds = frame / sequence.framesPerSecond, selection.isFrame = true;
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
    const FrameRange all{0, sequence.turntable > 0 ? sequence.turntable - 1 : 0};
    const FrameRange frames = sequence.frames.value_or(all);
    std::vector<RenderOptions> pictures;
    // The file is read again for each moment of its animation.
    const bool isReadAgain = sequence.turntable == 0 && frames.last > frames.first;
    const auto decoded = isReadAgain ? std::make_shared<build::PictureStore>() : nullptr;
    for (uint32_t frame = frames.first; frame <= frames.last; ++frame) {
        pictures.push_back(optionsOfFrame(asked, frame));
        pictures.back().scene.reading.pictures = decoded;
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
