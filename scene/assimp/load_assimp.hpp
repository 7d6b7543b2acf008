#pragma once

#include "scene/build/conventions.hpp"
#include "scene/model/scene.hpp"

#include <filesystem>

namespace stromboli {

/// Whether a file's ending, in small letters (".fbx"), is that of a format that Assimp reads, and
/// that this program does not read by itself.
bool isAssimpFormat(const std::string& suffix);

/// Reads a file with Assimp (https://assimp.org): meshes and where they stand, materials as those
/// of OBJ files (docs/guide/obj_ply.md), pictures, cameras and lights. Throws SceneError where
/// Assimp cannot read the file, with its words, and where it is not installed, with how to do that.
Scene loadWithAssimp(const std::filesystem::path& file, const SceneConventions& conventions = {});

} // namespace stromboli
