#pragma once

#include "scene/collada/context.hpp"

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace stromboli::collada {

/// True if no component is NaN or infinite.
inline bool isFinite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// The vector made unit, whatever its length; nothing if it has no direction.
inline std::optional<glm::dvec3> unit(const glm::dvec3& v) {
    if (!isFinite(v) || v == glm::dvec3(0)) return std::nullopt;
    const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    return glm::normalize(v / largest);
}

/// True for finite points whose coordinates the renderer accepts.
inline bool inRange(const glm::dvec3& p) {
    return std::abs(p.x) <= kLargestCoordinate && std::abs(p.y) <= kLargestCoordinate &&
           std::abs(p.z) <= kLargestCoordinate;
}

} // namespace stromboli::collada
