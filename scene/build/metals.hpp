#pragma once

#include <glm/glm.hpp>

#include <span>
#include <string_view>

namespace stromboli::build {

/// Complex index of refraction of a metal, in three channels.
struct MetalIndex {
    glm::dvec3 eta{0.0}, k{1.0}; ///< those of none, which reflects all light
};

struct NamedMetal {
    std::string_view name;
    MetalIndex index;
};

/// Measured spectra under the CIE 1931 curves, in Rec. 709 primaries, as renderers that work in
/// three channels publish them (the table of the renderer Tungsten). The first one is "none".
std::span<const NamedMetal> namedMetals();

} // namespace stromboli::build
