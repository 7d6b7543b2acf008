#include "scene/find_scene.hpp"

#include "host/core/error.hpp"
#include "scene/generate/generated_scene.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <filesystem>

namespace stromboli {
namespace {

namespace fs = std::filesystem;

/// Where the bundled scenes are: installed with the program that runs, else in the folder that it
/// was built from. An installed program may be moved with its whole prefix, and sources may be
/// gone.
fs::path sceneLibrary() {
    std::error_code failed;
    const fs::path program = fs::read_symlink("/proc/self/exe", failed);
    fs::path installed = program.parent_path() / STROMBOLI_SCENES_FROM_PROGRAM;
    if (!failed && fs::is_directory(installed, failed)) return installed.lexically_normal();
    return STROMBOLI_SCENE_LIBRARY;
}

bool isLibraryScene(const std::string& name) {
    const std::vector<std::string> names = librarySceneNames();
    return std::binary_search(names.begin(), names.end(), name);
}

} // namespace

std::vector<std::string> librarySceneNames() {
    std::vector<std::string> names;
    std::error_code failed; // a program without its files has no library
    for (const fs::directory_entry& entry : fs::directory_iterator(sceneLibrary(), failed))
        if (entry.path().extension() == ".dae") names.push_back(entry.path().stem().string());
    std::sort(names.begin(), names.end());
    return names;
}

std::string sceneFile(const std::string& name) {
    if (name.starts_with(kGeneratePrefix)) return {};
    // A folder, such as `study` makes and names after its scene, does not hide the scene.
    std::error_code failed;
    const fs::file_status status = fs::status(name, failed);
    if (status.type() != fs::file_type::directory && status.type() != fs::file_type::not_found)
        return name;
    if (isLibraryScene(name)) return (sceneLibrary() / (name + ".dae")).string();
    if (status.type() == fs::file_type::directory) return name;
    throw SceneError(name, 0, "",
                     fmt::format("there is no such file, and no bundled scene of this name; those "
                                 "are {}",
                                 fmt::join(librarySceneNames(), ", ")));
}

} // namespace stromboli
