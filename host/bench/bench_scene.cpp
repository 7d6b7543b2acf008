#include "host/bench/bench_scene.hpp"

#include "host/core/error.hpp"
#include "scene/generate/generated_scene.hpp"
#include "scene/read_scene.hpp"

#include <filesystem>

namespace stromboli::bench {
std::string benchSceneFile(const std::string& name) {
    if (name.starts_with(kGeneratePrefix)) return {};
    if (std::filesystem::exists(name)) return name;
    const std::filesystem::path inLibrary =
        std::filesystem::path(STROMBOLI_SCENE_LIBRARY) / (name + ".dae");
    if (std::filesystem::exists(inLibrary)) return inLibrary.string();
    throw SceneError(name, 0, "", "no such file, nor such a scene in " STROMBOLI_SCENE_LIBRARY);
}

BenchScene loadBenchScene(const std::string& name) {
    const std::string file = benchSceneFile(name);
    return {name, file, readScene(file.empty() ? name : file)};
}

} // namespace stromboli::bench
