#pragma once

#include "scene/mitsuba/plugin.hpp"

#include <glm/glm.hpp>

namespace stromboli::mitsuba {

/// How much a medium scatters and absorbs, per millimetre for those with a name.
struct Scattering {
    glm::dvec3 scattered{0.0}, absorbed{0.0};

    glm::dvec3 extinction() const { return scattered + absorbed; }
    glm::dvec3 albedo() const;
};

/// By sigma_s and sigma_a, by sigma_t and albedo, or by `material`.
Scattering scatteringOf(const Plugin& plugin);

} // namespace stromboli::mitsuba
