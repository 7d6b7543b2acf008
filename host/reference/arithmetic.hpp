#pragma once

#include <glm/glm.hpp>

namespace stromboli::reference {

/// Of the channels.
inline double mean(const glm::dvec3& color) {
    return (color.x + color.y + color.z) / 3;
}

inline double square(double x) {
    return x * x;
}

} // namespace stromboli::reference
