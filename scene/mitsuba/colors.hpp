#pragma once

#include "scene/mitsuba/plugin.hpp"

#include <glm/glm.hpp>

#include <optional>
#include <string_view>

namespace stromboli::mitsuba {

/// What a colour is of: spectra mean different colours as light and as fractions of it, or as
/// indices of refraction.
enum class ColorOf { Light, Reflectance, Index };

/// A parameter that is a colour: a number, rgb, a spectrum, or an object that is alike everywhere.
/// Nothing if there is none, or if it is a texture.
std::optional<glm::dvec3> colorOf(const Plugin& plugin, std::string_view name, ColorOf what);

} // namespace stromboli::mitsuba
