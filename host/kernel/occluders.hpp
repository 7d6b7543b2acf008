#pragma once

#include <glm/glm.hpp>

#include <vector>

namespace stromboli {

/// A rectangle through which no light passes.
struct Occluder {
    glm::dvec3 middle{0};
    glm::dvec3 normal{0, 0, 1};             ///< unit
    glm::dvec3 halfAcross{0}, halfAlong{0}; ///< at right angles, from the middle to two sides
};

struct Occluders {
    std::vector<Occluder> all; ///< the one that stops most first; at most MOST_OCCLUDERS
    /// A ray crosses one where it comes from so far before its plane, and would end so far behind.
    double thickness = 0;
};

} // namespace stromboli
