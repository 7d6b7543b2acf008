#pragma once

#include <glm/glm.hpp>

namespace stromboli::sky {

/// The mean radiance of the sun's disk as it comes through the atmosphere, as Mitsuba 0.x has it:
/// by A. J. Preetham, P. Shirley and B. Smits, "A Practical Analytic Model for Daylight", 1999,
/// whose appendix has the tables. zenith: the angle between the sun and the zenith, radians, at
/// most pi / 2; turbidity: 1 to 10. W m^-2 sr^-1 nm^-1, in Rec. 709.
glm::dvec3 sunRadiance(double zenith, double turbidity);

} // namespace stromboli::sky
