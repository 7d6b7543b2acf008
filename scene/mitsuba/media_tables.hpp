#pragma once

#include "scene/build/metals.hpp"
#include "scene/mitsuba/plugin.hpp"

namespace stromboli::mitsuba {

/// The index of refraction that a parameter states as a number or by a name such as water.
double refractiveIndex(const Plugin& plugin, std::string_view name, std::string_view otherwise);

using build::MetalIndex;

/// By `material`, or by `eta` and `k`.
MetalIndex metalIndex(const Plugin& plugin);

} // namespace stromboli::mitsuba
