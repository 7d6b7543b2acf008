#include "host/film/view_transform.hpp"

#include "host/core/chromaticity.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace stromboli {
namespace {

/// Negative channels and NaN become 0.
glm::dvec3 finiteLight(const glm::dvec3& radiance) {
    constexpr double most = std::numeric_limits<float>::max();
    glm::dvec3 light(0);
    for (int c = 0; c < 3; ++c)
        if (radiance[c] > 0) light[c] = std::min(radiance[c], most);
    return light;
}

// --- AgX -----------------------------------------------------------------------------------------

// Troy Sobotka's AgX (github.com/sobotka/AgX, 2022) as Blender 4 has it (Eary Chow,
// "AgXBaseRec2020" of github.com/EaryChow/AgX_LUT_Gen): in Rec. 2020, between an inset of the
// primaries and its undoing, each channel by a sigmoid of its logarithm. The numbers are those of
// Filament and of three.js (AgXToneMapping); for Blender's table stands the polynomial of degree
// six by Benjamin Wrensch ("Minimal AgX Implementation", iolite-engine.com, 2023), which is as
// close to it as a mean squared error of 3.7e-6. It is without a "look".

/// Columns.
constexpr glm::dmat3 kAgXInset{0.856627153315983,  0.137318972929847, 0.11189821299995,
                               0.0951212405381588, 0.761241990602591, 0.0767994186031903,
                               0.0482516061458583, 0.101439036467562, 0.811302368396859};
constexpr glm::dmat3 kAgXOutset{1.1271005818144368,    -0.1413297634984383,   -0.14132976349843826,
                                -0.11060664309660323,  1.157823702216272,     -0.11060664309660294,
                                -0.016493938717834573, -0.016493938717834257, 1.2519364065950405};

/// The logarithms (base 2) of what becomes black and of what becomes white: 10 stops below middle
/// grey, 0.18, and 6.5 above it.
constexpr double kAgXLeast = -12.47393, kAgXMost = 4.026069;

double agxSigmoid(double x) {
    const double x2 = x * x, x4 = x2 * x2;
    return 15.5 * x4 * x2 - 40.14 * x4 * x + 31.96 * x4 - 6.868 * x2 * x + 0.4298 * x2 +
           0.1191 * x - 0.00232;
}

glm::dvec3 agx(const glm::dvec3& radiance) {
    static const glm::dmat3 kTo2020 = glm::inverse(xyzFromRgb(kRec2020)) * xyzFromRgb(kRec709);
    static const glm::dmat3 kInset = kAgXInset * kTo2020;
    static const glm::dmat3 kFrom2020 = glm::inverse(kTo2020);
    glm::dvec3 color = kInset * radiance;
    for (int c = 0; c < 3; ++c) {
        const double stops = std::log2(std::max(color[c], 1e-10));
        color[c] = agxSigmoid(std::clamp((stops - kAgXLeast) / (kAgXMost - kAgXLeast), 0.0, 1.0));
    }
    color = kAgXOutset * color;
    for (int c = 0; c < 3; ++c)
        color[c] = std::pow(std::max(color[c], 0.0), 2.2); // the sigmoid is of signals
    return kFrom2020 * color;
}

// --- Filmic --------------------------------------------------------------------------------------

// John Hable, "Filmic Tonemapping Operators" (filmicworlds.com, 2010), the curve of Uncharted 2. Of
// the curves that go by this name it is the one that is defined by its formula, of named parts:
// toe, straight line and shoulder, with a white that is reached, at 5.6 times the radiance of
// Standard's. Narkowicz's and Hill's are fits of ACES, whose own definition is a table with other
// results.
double filmicCurve(double x) {
    constexpr double shoulderStrength = 0.15, linearStrength = 0.50, linearAngle = 0.10,
                     toeStrength = 0.20, toeNumerator = 0.02, toeDenominator = 0.30;
    return (x * (shoulderStrength * x + linearAngle * linearStrength) +
            toeStrength * toeNumerator) /
               (x * (shoulderStrength * x + linearStrength) + toeStrength * toeDenominator) -
           toeNumerator / toeDenominator;
}

glm::dvec3 filmic(const glm::dvec3& radiance) {
    constexpr double linearWhite = 11.2, exposureBias = 2;
    const double white = filmicCurve(linearWhite);
    glm::dvec3 light(0);
    for (int c = 0; c < 3; ++c)
        light[c] = filmicCurve(exposureBias * radiance[c]) / white;
    return light;
}

// --- PBR Neutral ---------------------------------------------------------------------------------

// "Khronos PBR Neutral Tone Mapper", specification of 2024 (github.com/KhronosGroup/ToneMapping): a
// colour under grey light becomes the base colour of its material, less what its surface reflects
// without colour (0.04, a dielectric of index 1.5 seen from the front); above 0.8 it is compressed
// and fades.
glm::dvec3 pbrNeutral(const glm::dvec3& radiance) {
    constexpr double fresnel = 0.04, compressedFrom = 0.8 - fresnel, desaturation = 0.15;
    const double least = std::min({radiance.x, radiance.y, radiance.z});
    const double offset = least < 2 * fresnel ? least - least * least / (4 * fresnel) : fresnel;
    const glm::dvec3 color = radiance - offset;
    const double peak = std::max({color.x, color.y, color.z});
    if (peak < compressedFrom) return color;
    constexpr double room = 1 - compressedFrom;
    const double newPeak = 1 - room * room / (peak + room - compressedFrom);
    const double faded = 1 - 1 / (desaturation * (peak - newPeak) + 1);
    return glm::mix(color * (newPeak / peak), glm::dvec3(newPeak), faded);
}

glm::dvec3 viewed(View view, const glm::dvec3& radiance) {
    switch (view) {
    case View::AgX:
        return agx(radiance);
    case View::Filmic:
        return filmic(radiance);
    case View::PbrNeutral:
        return pbrNeutral(radiance);
    case View::Standard:
        break;
    }
    return radiance;
}

} // namespace

glm::dvec3 displayLight(View view, const glm::dvec3& radiance) {
    return glm::clamp(viewed(view, finiteLight(radiance)), 0.0, 1.0);
}

} // namespace stromboli
