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

/// `name`: as readScene understands it. Throws SceneError.
BenchScene loadBenchScene(const std::string& name);

} // namespace stromboli::bench
