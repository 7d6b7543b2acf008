#include "host/film/white_balance.hpp"

#include <limits>

namespace stromboli {
namespace {

/// CIE 224:2017, as ANSI/IES TM-30-18: a reference light is a black body up to the first of these,
/// daylight from the second on, and between them a mixture of both of the same luminance.
constexpr double kLastBlackBody = 4000, kFirstDaylight = 5000;

/// CIE's diagram of 1960, in which the nearest illuminant is defined.
glm::dvec2 uvOf(const Chromaticity& c) {
    return glm::dvec2(4 * c.x, 6 * c.y) / (-2 * c.x + 12 * c.y + 3);
}

Chromaticity fromUv(double u, double v) {
    const double d = 2 * u - 8 * v + 4;
    return {3 * u / d, 2 * v / d};
}

/// Krystek, "An algorithm to calculate correlated colour temperature" (Color Research &
/// Application 10, 1985): u and v of a black body from 1000 to 15000 K, within 9e-5.
Chromaticity blackBody(double t) {
    return fromUv((0.860117757 + 1.54118254e-4 * t + 1.28641212e-7 * t * t) /
                      (1 + 8.42420235e-4 * t + 7.08145163e-7 * t * t),
                  (0.317398726 + 4.22806245e-5 * t + 4.20481691e-8 * t * t) /
                      (1 - 2.89741816e-5 * t + 1.61456053e-7 * t * t));
}

/// CIE 15:2004, illuminants D: daylight from 4000 to 25000 K. D65 is that of 6504 K.
Chromaticity daylight(double t) {
    const double x = t <= 7000 ? ((-4.6070e9 / t + 2.9678e6) / t + 0.09911e3) / t + 0.244063
                               : ((-2.0064e9 / t + 1.9018e6) / t + 0.24748e3) / t + 0.237040;
    return {x, (-3.000 * x + 2.870) * x - 0.275};
}

} // namespace

Chromaticity illuminantOf(double kelvin) {
    if (kelvin <= kLastBlackBody) return blackBody(kelvin);
    if (kelvin >= kFirstDaylight) return daylight(kelvin);
    const glm::dvec3 mixed =
        glm::mix(xyzOf(blackBody(kelvin)), xyzOf(daylight(kelvin)),
                 (kelvin - kLastBlackBody) / (kFirstDaylight - kLastBlackBody));
    const double sum = mixed.x + mixed.y + mixed.z;
    return {mixed.x / sum, mixed.y / sum};
}

glm::dmat3 whiteBalance(double kelvin) {
    const glm::dmat3 toXyz = xyzFromRgb(kRec709);
    return glm::inverse(toXyz) * chromaticAdaptation(xyzOf(illuminantOf(kelvin)), xyzOf(kD65)) *
           toXyz;
}

double nearestTemperature(const glm::dvec3& light) {
    const glm::dvec3 xyz = xyzFromRgb(kRec709) * light;
    const double sum = xyz.x + xyz.y + xyz.z;
    const glm::dvec2 place = uvOf({xyz.x / sum, xyz.y / sum});
    double nearest = kLeastKelvin, least = std::numeric_limits<double>::max();
    for (double kelvin = kLeastKelvin; kelvin <= kMostKelvin; ++kelvin) {
        const double distance = glm::distance(place, uvOf(illuminantOf(kelvin)));
        if (distance < least) nearest = kelvin, least = distance;
    }
    return nearest;
}

} // namespace stromboli
