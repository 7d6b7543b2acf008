#pragma once

#include "host/render/settings.hpp"
#include "scene/camera/camera.hpp"
#include "scene/model/scene.hpp"

#include <string>

namespace stromboli::bench {

struct BenchScene {
    std::string name;
    std::string file; ///< empty: made in memory
    Scene scene;
};

/// `name`: a file, a scene of scene/library without ".dae", or what scene/generate can make
/// ("generate:cornell_mesh:1000000"). Throws SceneError.
BenchScene loadBenchScene(const std::string& name);

/// The file that a name stands for, without loading it; empty for generated scenes. Throws
/// SceneError if there is none.
std::string benchSceneFile(const std::string& name);

} // namespace stromboli::bench
