#pragma once

#include <string>
#include <vector>

namespace stromboli {

/// The names of the bundled scenes (scene/library), which stand for their files everywhere.
std::vector<std::string> librarySceneNames();

/// The file that a scene's name stands for: a file, else a bundled scene. Empty for scenes that are
/// made in memory (kGeneratePrefix). Throws SceneError, with the names of the bundled scenes, if it
/// is none of these.
std::string sceneFile(const std::string& name);

/// The bundled environment that a bundled scene was made for, by its name; empty: it has light of
/// its own, or is none.
std::string usualEnvironment(const std::string& scene);

/// The picture that an environment's name stands for: a file, else a bundled picture of the sky.
/// Throws SceneError, with the names of the bundled ones, if it is neither.
std::string environmentFile(const std::string& name);

} // namespace stromboli
