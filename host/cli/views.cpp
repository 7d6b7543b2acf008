#include "host/cli/views.hpp"

#include "host/core/error.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <numeric>

namespace stromboli {
namespace {

namespace fs = std::filesystem;

std::string inLowerCase(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
}

/// Of letters and digits of ASCII, - and _, but no number: those are for cameras without.
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

std::vector<size_t> camerasMeant(const Options& asked, const Scene& scene) {
    std::vector<size_t> cameras;
    if (asked.cameras == std::vector<std::string>{"all"}) {
        if (scene.cameras.empty())
            throw SceneError(scene.file + ": has no camera; use --camera frame");
        cameras.resize(scene.cameras.size());
        std::iota(cameras.begin(), cameras.end(), size_t(0));
        return cameras;
    }
    for (const std::string& name : asked.cameras) {
        const size_t camera = *chosenCamera(scene, {CameraChoice::File, name}, asked.framing);
        if (std::ranges::count(cameras, camera) > 0)
            throw UsageError(fmt::format("--camera names camera {} '{}' twice", camera + 1,
                                         scene.cameras[camera].name));
        cameras.push_back(camera);
    }
    return cameras;
}

Options optionsOf(const Options& asked, const Scene& scene, size_t camera) {
    Options o = asked;
    const std::string word = wordFor(scene.cameras, camera);
    o.camera.choice = CameraChoice::File;
    o.camera.name.clear();
    o.camera.place = camera;
    o.cameras.clear();
    o.output = fileFor(asked.output, word);
    if (!asked.statsFile.empty()) o.statsFile = fileFor(asked.statsFile, word);
    if (!asked.checkpointFile.empty() && asked.checkpointFile != "off")
        o.checkpointFile = fileFor(asked.checkpointFile, word);
    // The picture is the one of this camera alone, and says so.
    for (std::string& part : o.pictureCommand)
        if (part.starts_with("--camera ")) part = fmt::format("--camera {}", camera + 1);
    return o;
}

} // namespace

std::vector<Options> optionsOfPictures(const Options& asked, const Scene& scene) {
    // A camera whose own name has a comma is one.
    const bool isOneName = std::ranges::any_of(
        scene.cameras, [&](const FileCamera& c) { return c.name == asked.camera.name; });
    if (asked.cameras.empty() || (isOneName && asked.camera.name != "all")) return {asked};
    std::vector<Options> all;
    for (const size_t camera : camerasMeant(asked, scene))
        all.push_back(optionsOf(asked, scene, camera));
    return all;
}

} // namespace stromboli
