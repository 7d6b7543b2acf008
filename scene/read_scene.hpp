#pragma once

#include "scene/build/conventions.hpp"
#include "scene/model/scene.hpp"

#include <string>

namespace stromboli {

/// A scene as a user names it: a file in one of the formats of scene/read_scene.cpp, a bundled
/// scene by its name (scene/find_scene.hpp), or kGeneratePrefix and the name of a scene that is
/// made in memory. The format is told by the ending of the file's name, in capital or small
/// letters, and where that says nothing, by the first bytes of the file. Throws SceneError for
/// whatever cannot be read, with the names of the formats where none of them fits, and for
/// generated scenes with other conventions than the default, which are about files.
Scene readScene(const std::string& source, const SceneConventions& conventions = {});

} // namespace stromboli
