#pragma once

#include "scene/build/conventions.hpp"
#include "scene/model/scene.hpp"

#include <filesystem>
#include <string_view>

namespace stromboli {

/// Whose colours those of the corners are. A face that has none is white.
enum class PlyColors { OfVertices, OfFaces };

/// Reads a PLY file, ASCII or binary; docs/obj_ply_files.md says what of it. Throws SceneError with
/// file and line, or in binary files element and number, for anything it cannot make sense of.
Scene loadPly(const std::filesystem::path& file, const SceneConventions& conventions = {});
Scene loadPlyWith(PlyColors colors, const std::filesystem::path& file,
                  const SceneConventions& conventions);

/// True if a file begins with the line "ply".
bool looksLikePly(std::string_view beginning);

} // namespace stromboli
