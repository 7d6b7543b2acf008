#pragma once

#include "host/engine/listener.hpp"
#include "scene/add_environment.hpp"
#include "scene/build/conventions.hpp"
#include "scene/model/scene.hpp"

#include <memory>
#include <string>

namespace stromboli {

/// Where a scene comes from, how its file is read, and what lights it from all around.
struct SceneRequest {
    std::string source; ///< a file, a bundled scene or a generated one (scene/read_scene.hpp)
    SceneConventions reading;
    EnvironmentRequest environment;
};

/// A scene in memory. Sessions share it and do not change it; nor may others while one uses it.
struct LoadedScene {
    std::shared_ptr<Scene> scene;
    double seconds = 0; ///< that reading took
};

/// Reads or makes the scene, and reports what of its file was ignored, forgiven or assumed. Throws
/// SceneError.
LoadedScene loadScene(const SceneRequest& request, const Listener& listener = {});

/// Another moment of the file that `before` was loaded from, without a report. Where nothing but
/// cameras moves, it is the scene of `before` with its cameras as they are then, so that sessions
/// keep what they have built of it. Else the environment, which no moment changes, is taken out of
/// `before`, which is of no use any more.
LoadedScene loadMoment(const SceneRequest& request, LoadedScene before,
                       const Listener& listener = {});

} // namespace stromboli
