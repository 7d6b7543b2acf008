#pragma once

#include "scene/model/scene.hpp"

#include <filesystem>

namespace stromboli {

struct LoadOptions {
    /// Read the file as the CS184 renderer does (docs/cs184.md): recomputed vertex normals,
    /// lights placed and aimed by its rules, unit ignored.
    bool cs184 = false;
};

/// Reads a COLLADA 1.4 or 1.5 file, with the CS184 dialect (profile CGL or CMU462).
/// Throws SceneError with file, line and element for anything it cannot make sense of.
Scene loadCollada(const std::filesystem::path& file, const LoadOptions& options = {});

} // namespace stromboli
