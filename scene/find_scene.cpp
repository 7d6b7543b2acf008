#include "scene/find_scene.hpp"

#include "host/core/error.hpp"
#include "host/core/nearest_name.hpp"
#include "scene/generate/generated_scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <dlfcn.h>

#include <algorithm>
#include <filesystem>
#include <initializer_list>
#include <map>
#include <string_view>
#include <vector>

namespace stromboli {
namespace {

namespace fs = std::filesystem;

/// The folder of the shared library that this code is in; empty where it is in the program.
fs::path libraryFolder(const fs::path& program) {
    Dl_info info;
    if (!dladdr(reinterpret_cast<const void*>(&librarySceneNames), &info) || !info.dli_fname)
        return {};
    const fs::path file = info.dli_fname;
    std::error_code failed;
    if (!file.has_parent_path() || fs::equivalent(file, program, failed)) return {};
    return file.parent_path();
}

/// Where the bundled scenes are: installed with the program or library that runs, else in the
/// folder that it was built from. An installed program may be moved with its whole prefix, and
/// sources may be gone.
fs::path sceneLibrary() {
    std::error_code failed;
    const fs::path program = fs::read_symlink("/proc/self/exe", failed);
    std::vector<fs::path> places;
    if (const fs::path folder = libraryFolder(program); !folder.empty())
        places = {folder / "scenes", folder / STROMBOLI_SCENES_FROM_LIBRARY};
    if (!program.empty()) places.push_back(program.parent_path() / STROMBOLI_SCENES_FROM_PROGRAM);
    for (const fs::path& place : places)
        if (fs::is_directory(place, failed)) return place.lexically_normal();
    return STROMBOLI_SCENE_LIBRARY;
}

/// The bundled files with one of these endings, by their names without it.
std::map<std::string, fs::path> libraryFiles(std::initializer_list<std::string_view> endings) {
    std::map<std::string, fs::path> files;
    std::error_code failed; // a program without its files has no library
    for (const fs::directory_entry& entry : fs::directory_iterator(sceneLibrary(), failed))
        if (std::ranges::find(endings, entry.path().extension().string()) != endings.end())
            files[entry.path().stem().string()] = entry.path();
    return files;
}

std::map<std::string, fs::path> libraryScenes() {
    return libraryFiles({".dae", ".glb", ".xml"});
}

std::vector<std::string> namesOf(const std::map<std::string, fs::path>& files) {
    std::vector<std::string> names;
    for (const auto& [name, file] : files)
        names.push_back(name);
    return names;
}

/// Throws the SceneError that a name is that of no file and of nothing bundled: it names what may
/// have been meant, or else all there is.
[[noreturn]] void throwMissing(const std::string& name, const char* kind,
                               const std::vector<std::string>& bundled) {
    std::optional<std::string> meant = nearestName(name, bundled);
    if (!meant) meant = nearestFile(name);
    throw SceneError(name, 0, "",
                     fmt::format("there is no such file, and no bundled {} of this name; {}", kind,
                                 meant ? fmt::format("did you mean {}?", *meant)
                                       : fmt::format("those are {}", fmt::join(bundled, ", "))));
}

} // namespace

std::vector<std::string> librarySceneNames() {
    return namesOf(libraryScenes());
}

std::string sceneFile(const std::string& name) {
    if (name.starts_with(kGeneratePrefix)) return {};
    // A folder, such as `study` makes and names after its scene, does not hide the scene.
    std::error_code failed;
    const fs::file_status status = fs::status(name, failed);
    if (status.type() != fs::file_type::directory && status.type() != fs::file_type::not_found)
        return name;
    const std::map<std::string, fs::path> bundled = libraryScenes();
    if (const auto found = bundled.find(name); found != bundled.end())
        return found->second.string();
    if (status.type() == fs::file_type::directory) return name;
    throwMissing(name, "scene", namesOf(bundled));
}

std::string usualEnvironment(const std::string& scene) {
    std::error_code failed;
    return scene == "still_life" && !fs::is_regular_file(scene, failed) ? "evening_sky" : "";
}

std::string environmentFile(const std::string& name) {
    std::error_code failed;
    if (fs::exists(name, failed)) return name;
    const std::map<std::string, fs::path> bundled = libraryFiles({".hdr"});
    if (const auto found = bundled.find(name); found != bundled.end())
        return found->second.string();
    throwMissing(name, "environment", namesOf(bundled));
}

} // namespace stromboli
