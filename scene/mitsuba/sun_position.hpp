#pragma once

#include "scene/mitsuba/plugin.hpp"

namespace stromboli::mitsuba {

/// Where and when the sun is looked at; what Mitsuba takes where nothing is stated.
struct SunTime {
    double latitude = 35.6894, longitude = 139.6917; ///< degrees, to the north and the east
    double timezone = 9;                             ///< hours ahead of Greenwich
    int64_t year = 2010, month = 7, day = 10;
    double hour = 15, minute = 0, second = 0; ///< by the clock of the time zone
};

/// Throws SceneError for numbers out of range.
SunTime readSunTime(const Plugin& emitter);
/// Whether it says any of that.
bool statesSunTime(const Plugin& emitter);

/// Towards the sun, unit: x to the south, y to the west, z up.
glm::dvec3 sunDirection(const SunTime& time);

} // namespace stromboli::mitsuba
