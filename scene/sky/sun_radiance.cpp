#include "scene/sky/sun_radiance.hpp"

#include "scene/build/spectrum.hpp"

#include <glm/trigonometric.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

namespace stromboli::sky {
namespace {

using Sample = std::pair<double, double>; ///< wavelength in nanometres and value

/// Absorption by ozone, per centimetre.
constexpr std::array<Sample, 64> kOzone = {
    {{300, 10.0}, {305, 4.8},  {310, 2.7},  {315, 1.35}, {320, .8},   {325, .38},  {330, .16},
     {335, .075}, {340, .04},  {345, .019}, {350, .007}, {355, 0},    {445, .003}, {450, .003},
     {455, .004}, {460, .006}, {465, .008}, {470, .009}, {475, .012}, {480, .014}, {485, .017},
     {490, .021}, {495, .025}, {500, .03},  {505, .035}, {510, .04},  {515, .045}, {520, .048},
     {525, .057}, {530, .063}, {535, .07},  {540, .075}, {545, .08},  {550, .085}, {555, .095},
     {560, .103}, {565, .11},  {570, .12},  {575, .122}, {580, .12},  {585, .118}, {590, .115},
     {595, .12},  {600, .125}, {605, .13},  {610, .12},  {620, .105}, {630, .09},  {640, .079},
     {650, .067}, {660, .057}, {670, .048}, {680, .036}, {690, .028}, {700, .023}, {710, .018},
     {720, .014}, {730, .011}, {740, .01},  {750, .009}, {760, .007}, {770, .004}, {780, 0},
     {790, 0}}};

/// By mixed gases.
constexpr std::array<Sample, 4> kGases = {{{759, 0}, {760, 3}, {770, .21}, {771, 0}}};

/// By water vapour.
constexpr std::array<Sample, 13> kVapour = {{{689, 0},
                                             {690, .016},
                                             {700, .024},
                                             {710, .0125},
                                             {720, 1},
                                             {730, .87},
                                             {740, .061},
                                             {750, .001},
                                             {760, 1e-5},
                                             {770, 1e-5},
                                             {780, 6e-4},
                                             {790, .0175},
                                             {800, .036}}};

/// The sun above the atmosphere, every 10 nanometres from 380.
constexpr std::array kSun = {16559.0, 16233.7, 21127.5, 25888.2, 25829.1, 24232.3, 26760.5, 29658.3,
                             30545.4, 30057.5, 30663.7, 28830.4, 28712.1, 27825.0, 27100.6, 27233.6,
                             26361.3, 25503.8, 25060.2, 25311.6, 25355.9, 25134.2, 24631.5, 24173.2,
                             23685.3, 23212.1, 22827.7, 22339.8, 21970.2, 21526.7, 21097.9, 20728.3,
                             20240.4, 19870.8, 19427.2, 19072.4, 18628.9, 18259.2};

/// Linear between the samples, 0 outside.
double at(std::span<const Sample> samples, double wavelength) {
    if (wavelength < samples.front().first || wavelength > samples.back().first) return 0;
    const auto above = std::ranges::lower_bound(samples, wavelength, {}, &Sample::first);
    if (above == samples.begin()) return above->second;
    const auto below = above - 1;
    return std::lerp(below->second, above->second,
                     (wavelength - below->first) / (above->first - below->first));
}

double outside(double wavelength) {
    const double place = (wavelength - 380) / 10;
    if (place < 0 || place > double(kSun.size() - 1)) return 0;
    const auto below = std::min(size_t(place), kSun.size() - 2);
    return std::lerp(kSun[below], kSun[below + 1], place - double(below));
}

} // namespace

glm::dvec3 sunRadiance(double zenith, double turbidity) {
    // How much air there is on the way, relative to that overhead.
    const double mass =
        1 / (std::cos(zenith) + 0.15 * std::pow(93.885 - glm::degrees(zenith), -1.253));
    const double aerosols = 0.04608365822050 * turbidity - 0.04586025928522;
    constexpr double kOzoneDepth = 0.35, kWater = 2; // centimetres
    std::vector<Sample> arriving;
    for (double l = 350; l <= 800; l += 5) {
        const double micrometres = l / 1000;
        double depth = mass * 0.008735 * std::pow(micrometres, -4.08); // by Rayleigh
        depth += mass * aerosols * std::pow(micrometres, -1.3);
        depth += mass * at(kOzone, l) * kOzoneDepth;
        const double gases = at(kGases, l) * mass, vapour = at(kVapour, l) * kWater * mass;
        depth += 1.41 * gases / std::pow(1 + 118.93 * gases, 0.45);
        depth += 0.2385 * vapour / std::pow(1 + 20.07 * vapour, 0.45);
        arriving.emplace_back(l, outside(l) * std::exp(-depth));
    }
    return build::rgbOfLight(arriving);
}

} // namespace stromboli::sky
