#pragma once

#include "scene/build/conventions.hpp"
#include "scene/model/scene.hpp"

#include <filesystem>
#include <string_view>

namespace stromboli {

/// Reads a COLLADA 1.4 or 1.5 file, with the dialect CGL (cgl_dialect.hpp): a document in
/// UTF-8 or UTF-16, or an archive (.zae).
/// Throws SceneError with file, line and element for anything it cannot make sense of.
Scene loadCollada(const std::filesystem::path& file, const SceneConventions& conventions = {});

/// True if a file that begins like this is XML, in UTF-8 or UTF-16, whose root element is
/// <COLLADA>.
bool looksLikeCollada(std::string_view beginning);

/// True if a file that begins like this is a zip archive, as those of COLLADA (.zae) are.
bool looksLikeColladaArchive(std::string_view beginning);

} // namespace stromboli
