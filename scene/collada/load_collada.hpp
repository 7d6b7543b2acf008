#pragma once

#include "scene/build/conventions.hpp"
#include "scene/model/scene.hpp"

#include <filesystem>
#include <string_view>

namespace stromboli {

/// Reads a COLLADA 1.4 or 1.5 file, with the CS184 dialect (profile CGL or CMU462).
/// Throws SceneError with file, line and element for anything it cannot make sense of.
Scene loadCollada(const std::filesystem::path& file, const SceneConventions& conventions = {});

/// True if a file that begins like this is XML whose root element is <COLLADA>.
bool looksLikeCollada(std::string_view beginning);

} // namespace stromboli
