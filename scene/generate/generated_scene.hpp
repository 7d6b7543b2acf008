#pragma once

#include "scene/model/scene.hpp"

#include <array>
#include <string_view>

namespace stromboli {

/// Begins a scene that is made instead of read: "generate:cornell_mesh:1000000".
inline constexpr std::string_view kGeneratePrefix = "generate:";

/// What stands behind it, before a number.
inline constexpr std::string_view kCornellMesh = "cornell_mesh:", kEmittersRoom = "lamps:",
                                  kPointsRoom = "points:", kForest = "forest:";
inline constexpr std::array kGeneratedScenes = {kCornellMesh, kEmittersRoom, kPointsRoom, kForest};

/// The scene of this name, made in memory: "cornell_mesh:N" is scene/library/cornell_mesh.dae
/// with a mesh of N triangles, to within 1 %, for N from 1000 to 100000000; with 50000 it is that
/// file's, to within the rounding of its numbers. Always the same for the same name.
/// "lamps:N" is a room of 2 m with N emissive triangles spread through it, N a multiple of 8;
/// "points:N" the same with N point lights. "forest:N" is a field of N trees, instances that share
/// their triangles.
/// Throws SceneError if there is no such scene.
Scene generatedScene(std::string_view name);

} // namespace stromboli
