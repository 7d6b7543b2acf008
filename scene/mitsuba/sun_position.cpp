#include "scene/mitsuba/sun_position.hpp"

#include <fmt/format.h>
#include <glm/gtc/constants.hpp>
#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace stromboli::mitsuba {
namespace {

constexpr std::array kNames = {"latitude", "longitude", "timezone", "year",  "month",
                               "day",      "hour",      "minute",   "second"};

/// Days from noon of 1 January 2000 to the day's beginning, of the calendar of Gregory (Fliegel and
/// van Flandern 1968).
double daysSince2000(const SunTime& t) {
    const int64_t early = (t.month - 14) / 12; // -1 in January and February, else 0
    const int64_t day = 1461 * (t.year + 4800 + early) / 4 + 367 * (t.month - 2 - 12 * early) / 12 -
                        3 * ((t.year + 4900 + early) / 100) / 4 + t.day - 32075;
    return double(day - 2451545) - 0.5;
}

int64_t wholeIn(const Plugin& emitter, const char* name, int64_t otherwise, int64_t least,
                int64_t most) {
    const int64_t value = emitter.integer(name).value_or(otherwise);
    if (value < least || value > most)
        emitter.replaceParameter(name, build::Shortfall::Number,
                                 fmt::format("is {}, expected {} to {}", value, least, most));
    return std::clamp(value, least, most);
}

} // namespace

bool statesSunTime(const Plugin& emitter) {
    return std::ranges::any_of(kNames, [&](const char* name) { return emitter.has(name); });
}

SunTime readSunTime(const Plugin& emitter) {
    SunTime t;
    t.latitude = emitter.number("latitude", -90, 90).value_or(t.latitude);
    t.longitude = emitter.number("longitude", -360, 360).value_or(t.longitude);
    t.timezone = emitter.number("timezone", -24, 24).value_or(t.timezone);
    t.year = wholeIn(emitter, "year", t.year, 1600, 3000);
    t.month = wholeIn(emitter, "month", t.month, 1, 12);
    t.day = wholeIn(emitter, "day", t.day, 1, 31);
    t.hour = emitter.number("hour", 0, 24).value_or(t.hour);
    t.minute = emitter.number("minute", 0, 60).value_or(t.minute);
    t.second = emitter.number("second", 0, 60).value_or(t.second);
    return t;
}

/// The algorithm of Blanco-Muriel, Alarcon-Padilla, Lopez-Moratalla and Lara-Coira, Computing the
/// solar vector, Solar Energy 70 (2001): to half a minute of arc between 1999 and 2015.
glm::dvec3 sunDirection(const SunTime& t) {
    const double hours = t.hour - t.timezone + (t.minute + t.second / 60) / 60; // in Greenwich
    const double days = daysSince2000(t) + hours / 24;
    // The ecliptic.
    const double node = 2.1429 - 0.0010394594 * days;
    const double meanLongitude = 4.8950630 + 0.017202791698 * days;
    const double anomaly = 6.2400600 + 0.0172019699 * days;
    const double longitude = meanLongitude + 0.03341607 * std::sin(anomaly) +
                             0.00034894 * std::sin(2 * anomaly) - 0.0001134 -
                             0.0000203 * std::sin(node);
    const double obliquity = 0.4090928 - 6.2140e-9 * days + 0.0000396 * std::cos(node);
    // The sky as the stars have it.
    const double ascension =
        std::atan2(std::cos(obliquity) * std::sin(longitude), std::cos(longitude));
    const double declination = std::asin(std::sin(obliquity) * std::sin(longitude));
    // The sky of the place.
    const double greenwichTime = 6.6974243242 + 0.0657098283 * days + hours; // sidereal hours
    const double hourAngle = glm::radians(greenwichTime * 15 + t.longitude) - ascension;
    const double latitude = glm::radians(t.latitude);
    double zenith =
        std::acos(std::clamp(std::cos(latitude) * std::cos(hourAngle) * std::cos(declination) +
                                 std::sin(declination) * std::sin(latitude),
                             -1.0, 1.0));
    const double azimuth = std::atan2(-std::sin(hourAngle), // from the north to the east
                                      std::tan(declination) * std::cos(latitude) -
                                          std::sin(latitude) * std::cos(hourAngle));
    constexpr double kParallax = 6371.01 / 149597890; // the earth's radius over its distance, km
    zenith += kParallax * std::sin(zenith);
    return {-std::sin(zenith) * std::cos(azimuth), -std::sin(zenith) * std::sin(azimuth),
            std::cos(zenith)};
}

} // namespace stromboli::mitsuba
