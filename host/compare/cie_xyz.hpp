#pragma once

#include <glm/glm.hpp>

namespace stromboli::compare {

/// From linear RGB with ITU-R BT.709 primaries and white D65 to CIE XYZ (IEC 61966-2-1); columns.
inline const glm::dmat3 kXyzFromLinear{0.412453, 0.212671, 0.019334, 0.357580, 0.715160,
                                       0.119193, 0.180423, 0.072169, 0.950227};

} // namespace stromboli::compare
