#pragma once

#include "scene/build/conventions.hpp"
#include "scene/model/scene.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>

namespace stromboli {

/// What of a file the colours of corners are: `color` by any of its usual names, or another
/// attribute as Mitsuba names them: `name_r`, `name_g` and `name_b` are name_color, properties like
/// `name_x`, `name_0` are name, whose first number is taken for all three. A face without is white.
struct PlyAttribute {
    std::string name = "color";
    bool isOfFaces = false;
    /// Whether colours of vertices are sRGB; without a value whole numbers are, and floats are not.
    std::optional<bool> areSrgb = std::nullopt;
    /// Whether colours of wider types than bytes may be fractions of 255, where they look so.
    bool mayBeBytes = true;
};

/// Reads a PLY file, ASCII or binary; docs/guide/obj_ply.md says what of it. Throws SceneError with
/// file and line, or in binary files element and number, for anything it cannot make sense of.
Scene loadPly(const std::filesystem::path& file, const SceneConventions& conventions = {});
Scene loadPlyWith(const PlyAttribute& colors, const std::filesystem::path& file,
                  const SceneConventions& conventions);

/// How many faces a PLY file has, of any number of corners, as its header says; 0: it has no such
/// element. Throws as loadPly().
uint64_t facesOfPly(const std::filesystem::path& file);

/// True if a file begins with the line "ply".
bool looksLikePly(std::string_view beginning);

} // namespace stromboli
