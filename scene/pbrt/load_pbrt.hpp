#pragma once

#include "scene/build/conventions.hpp"
#include "scene/model/scene.hpp"

#include <filesystem>
#include <string_view>

namespace stromboli {

/// Reads a scene of pbrt-v3 or pbrt-v4; docs/guide/pbrt.md says what of it. Throws SceneError with
/// file, line and directive for what leaves nothing to show.
Scene loadPbrt(const std::filesystem::path& file, const SceneConventions& conventions = {});

/// True if a file that begins like this has a directive of pbrt first, behind comments.
bool looksLikePbrt(std::string_view beginning);

} // namespace stromboli
