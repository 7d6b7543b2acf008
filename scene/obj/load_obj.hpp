#pragma once

#include "scene/build/conventions.hpp"
#include "scene/model/scene.hpp"

#include <filesystem>
#include <string_view>

namespace stromboli {

/// Reads a Wavefront OBJ file with the MTL files and pictures that it names;
/// docs/guide/obj_ply.md says what of them. Throws SceneError with file and line for anything it
/// cannot make sense of.
Scene loadObj(const std::filesystem::path& file, const SceneConventions& conventions = {});

/// True if a file begins with statements of OBJ, one of which is a vertex: the format has no mark
/// of its own.
bool looksLikeObj(std::string_view beginning);

} // namespace stromboli
