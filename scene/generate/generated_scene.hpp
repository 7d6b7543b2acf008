#pragma once

#include "scene/collada/load_collada.hpp"
#include "scene/model/scene.hpp"

#include <string>
#include <string_view>

namespace stromboli {

/// Begins a scene that is made instead of read: "generate:cornell_mesh:1000000".
inline constexpr std::string_view kGeneratePrefix = "generate:";

/// The scene of this name, made in memory: "cornell_mesh:N" is scene/library/cornell_mesh.dae
/// with a mesh of N triangles, to within 1 %, for N from 1000 to 100000000; with 50000 it is that
/// file's, to within the rounding of its numbers. Always the same for the same name.
/// "lamps:N" is a room of 2 m with N emissive triangles spread through it, N a multiple of 8.
/// Throws SceneError if there is no such scene.
Scene generatedScene(std::string_view name);

/// A scene as a user names it: a COLLADA file, or kGeneratePrefix and the name of a generated one,
/// which knows no conventions of the CS184 renderer. Throws SceneError.
Scene readScene(const std::string& source, const LoadOptions& options = {});

} // namespace stromboli
