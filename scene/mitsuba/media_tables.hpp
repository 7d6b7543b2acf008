#pragma once

#include "scene/mitsuba/plugin.hpp"

#include <glm/glm.hpp>

namespace stromboli::mitsuba {

/// The index of refraction that a parameter states as a number or by a name such as water.
double refractiveIndex(const Plugin& plugin, std::string_view name, std::string_view otherwise);

/// Complex index of refraction of a metal.
struct MetalIndex {
    glm::dvec3 eta{0.0}, k{1.0}; ///< those of none, which reflects all light
};

/// By `material`, or by `eta` and `k`.
MetalIndex metalIndex(const Plugin& plugin);

} // namespace stromboli::mitsuba
