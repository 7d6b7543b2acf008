#pragma once

#include "scene/build/conventions.hpp"
#include "scene/model/scene.hpp"

#include <filesystem>
#include <string_view>

namespace stromboli {

/// Reads a glTF 2.0 file, as text (.gltf) or binary (.glb); docs/guide/gltf.md says what of it.
/// Throws SceneError with file and element for anything it cannot make sense of.
Scene loadGltf(const std::filesystem::path& file, const SceneConventions& conventions = {});

/// True if a file that begins like this is a JSON object with the member `asset`.
bool looksLikeGltf(std::string_view beginning);

/// True if a file that begins like this is binary glTF.
bool looksLikeBinaryGltf(std::string_view beginning);

} // namespace stromboli
