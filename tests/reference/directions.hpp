#pragma once

#include <glm/glm.hpp>

#include <cmath>

namespace stromboli::reference {

/// The unit vector at this cosine to z and this angle about it, from x.
inline glm::dvec3 direction(double cosine, double azimuth) {
    const double sine = std::sqrt(1 - cosine * cosine);
    return {sine * std::cos(azimuth), sine * std::sin(azimuth), cosine};
}

} // namespace stromboli::reference
