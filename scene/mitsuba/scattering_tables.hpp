#pragma once

#include "scene/build/subsurface.hpp"
#include "scene/mitsuba/plugin.hpp"

namespace stromboli::mitsuba {

using build::Scattering;

/// By sigma_s and sigma_a, by sigma_t and albedo, or by `material`, per millimetre for those.
Scattering scatteringOf(const Plugin& plugin);

} // namespace stromboli::mitsuba
