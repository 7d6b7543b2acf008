#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace stromboli {

/// Light from infinity, seen by the camera too, of a radiance that depends on the direction: an
/// equirectangular picture around the scene. Its upper edge is the direction +y, its middle column
/// -z, its left and right edges +z, and +x lies at three quarters of its width. Between the middles
/// of texels it is interpolated; above those of the first row and below those of the last it does
/// not change.
struct Environment {
    std::string name; ///< for messages
    uint32_t width = 1, height = 1;
    std::vector<glm::vec3> radiance{glm::vec3(0)}; ///< row after row, from the top; not negative
    float strength = 1;                            ///< multiplies the radiance
    float rotation = 0; ///< radians, about +y, counter-clockwise seen from above

    bool isConstant() const { return radiance.size() == 1; }
};

} // namespace stromboli
