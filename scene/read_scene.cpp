#include "scene/read_scene.hpp"

#include "host/core/error.hpp"
#include "scene/assimp/load_assimp.hpp"
#include "scene/build/read_file.hpp"
#include "scene/collada/load_collada.hpp"
#include "scene/find_scene.hpp"
#include "scene/generate/generated_scene.hpp"
#include "scene/gltf/load_gltf.hpp"
#include "scene/mitsuba/load_mitsuba.hpp"
#include "scene/model/placements.hpp"
#include "scene/obj/load_obj.hpp"
#include "scene/pbrt/load_pbrt.hpp"
#include "scene/ply/load_ply.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <string_view>
#include <system_error>
#include <utility>
#include <vector>

namespace stromboli {
namespace {

/// One kind of scene file. Another loader is another line of kFormats.
struct Format {
    std::string_view name;   ///< for messages
    std::string_view suffix; ///< of file names, in small letters; empty: the content decides
    bool (*looksLikeIt)(std::string_view beginning);
    Scene (*load)(const std::filesystem::path& file, const SceneConventions& conventions);
    bool hasSelection = false;   ///< its files hold what FileSelection::option asks for
    bool hasDefinitions = false; ///< its files have values that FileSelection::definitions replace
    bool saysWhatIsUp = true;
    bool mayBePacked = false; ///< by gzip; the ending is then .gz behind the format's own
};

constexpr Format kFormats[] = {
    {"COLLADA (.dae, or XML whose root element is <COLLADA>)", ".dae", looksLikeCollada,
     loadCollada},
    {"COLLADA archive (.zae)", ".zae", looksLikeColladaArchive, loadCollada},
    {"glTF 2.0 (.gltf)", ".gltf", looksLikeGltf, loadGltf, true},
    {"binary glTF 2.0 (.glb)", ".glb", looksLikeBinaryGltf, loadGltf, true},
    {"PLY (.ply)", ".ply", looksLikePly, loadPly, false, false, false, true},
    {"Mitsuba (XML whose root element is <scene>)", "", looksLikeMitsuba, loadMitsuba, false, true},
    {"pbrt (.pbrt)", ".pbrt", looksLikePbrt, loadPbrt, false, false, true, true},
    // The last one: it has no mark of its own.
    {"Wavefront OBJ (.obj)", ".obj", looksLikeObj, loadObj, false, false, false, true},
};

/// Told by its ending alone.
constexpr Format kByAssimp = {"of a format that Assimp reads (.stl, .fbx, .3ds, ...)",
                              "",
                              nullptr,
                              loadWithAssimp,
                              false,
                              false,
                              false};

/// What is looked at to tell a format. Comments may stand before the first element.
constexpr size_t kBeginning = 65536;

std::string suffixOf(const std::filesystem::path& file) {
    std::string suffix = file.extension().string();
    std::transform(suffix.begin(), suffix.end(), suffix.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    return suffix;
}

const Format* byName(const std::filesystem::path& file) {
    const std::string suffix = suffixOf(file);
    if (suffix == ".gz") {
        const std::string inner = suffixOf(file.stem());
        for (const Format& format : kFormats)
            if (format.mayBePacked && inner == format.suffix) return &format;
    }
    for (const Format& format : kFormats)
        if (!suffix.empty() && suffix == format.suffix) return &format;
    return isAssimpFormat(suffix) ? &kByAssimp : nullptr;
}

const Format* byContent(const std::filesystem::path& file) {
    const std::string beginning = build::readFile(file, kBeginning);
    for (const Format& format : kFormats)
        if (format.looksLikeIt(beginning)) return &format;
    return nullptr;
}

std::string formatNames() {
    std::string names;
    for (const Format& format : kFormats)
        names += fmt::format("{}{}", names.empty() ? "" : ", ", format.name);
    return names + ", or a file " + std::string(kByAssimp.name);
}

/// Throws SceneError with the scenes that a folder has.
[[noreturn]] void refuseFolder(const std::filesystem::path& folder) {
    std::vector<std::string> scenes;
    std::error_code failed; // a folder that cannot be read has none
    for (const auto& entry : std::filesystem::directory_iterator(folder, failed))
        if (byName(entry.path()) || suffixOf(entry.path()) == ".xml")
            scenes.push_back(entry.path().filename().string());
    std::ranges::sort(scenes);
    constexpr size_t most = 5;
    const size_t shown = std::min(scenes.size(), most);
    std::string names;
    for (size_t i = 0; i < shown; ++i)
        names += fmt::format("{}{}", i == 0 ? "; it has " : ", ", scenes[i]);
    if (scenes.size() > shown) names += fmt::format(" and {} others", scenes.size() - shown);
    throw SceneError(folder.string(), 0, "", "is a directory, expected a scene file" + names);
}

} // namespace

Scene readScene(const std::string& source, const SceneConventions& conventions) {
    const std::string_view selects = conventions.selection.option();
    const bool defines = !conventions.selection.definitions.empty();
    const auto refuseSelection = [&](std::string_view what) {
        throw SceneError(fmt::format("{}: {} is about glTF files; {}", source, selects, what));
    };
    const bool turns = conventions.up != UpAxis::Y;
    const auto refuseUp = [&](std::string_view what) {
        throw SceneError(fmt::format("{}: --up is about files that do not say which axis is up "
                                     "(OBJ, PLY, STL, ...); {}",
                                     source, what));
    };
    if (source.starts_with(kGeneratePrefix)) {
        if (!conventions.areDefault())
            throw SceneError(fmt::format("{}: {} is about files; a generated scene has no use "
                                         "for it",
                                         source, conventions.option));
        if (defines) throw SceneError(source + ": -D is about Mitsuba scenes");
        if (!selects.empty()) refuseSelection("a generated scene has no use for it");
        if (turns) refuseUp("a generated scene has no use for it");
        Scene scene = generatedScene(std::string_view(source).substr(kGeneratePrefix.size()));
        return conventions.instances == InstanceSharing::Off ? expandPlacements(scene).scene
                                                             : std::move(scene);
    }
    const std::filesystem::path file = sceneFile(source);
    std::error_code failed;
    if (std::filesystem::is_directory(file, failed)) refuseFolder(file);
    const Format* format = byName(file);
    if (!format) format = byContent(file);
    if (!format)
        throw SceneError(source, 0, "",
                         fmt::format("is in no format that is read; expected {}, or {}NAME for a "
                                     "scene that is made in memory",
                                     formatNames(), kGeneratePrefix));
    if (!selects.empty() && !format->hasSelection)
        refuseSelection(fmt::format("this one is {}", format->name));
    if (defines && !format->hasDefinitions)
        throw SceneError(
            fmt::format("{}: -D is about Mitsuba scenes; this one is {}", source, format->name));
    if (turns && format->saysWhatIsUp) refuseUp(fmt::format("this one is {}", format->name));
    return format->load(file, conventions);
}

} // namespace stromboli
