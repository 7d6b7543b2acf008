#pragma once

#include <glm/glm.hpp>

namespace stromboli {

/// Luminance of linear RGB with the primaries of Rec. 709 (ITU-R BT.709).
inline double luminance(const glm::dvec3& color) {
    return 0.2126 * color.x + 0.7152 * color.y + 0.0722 * color.z;
}

} // namespace stromboli
