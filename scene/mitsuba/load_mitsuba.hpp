#pragma once

#include "scene/build/conventions.hpp"
#include "scene/model/scene.hpp"

#include <filesystem>
#include <string_view>

namespace stromboli {

/// Reads a scene of Mitsuba (XML, of version 3 or earlier); docs/guide/mitsuba.md says what of it.
/// Throws SceneError with file, line and element for anything it cannot make sense of.
Scene loadMitsuba(const std::filesystem::path& file, const SceneConventions& conventions = {});

/// True if a file that begins like this is XML whose root element is <scene>.
bool looksLikeMitsuba(std::string_view beginning);

} // namespace stromboli
