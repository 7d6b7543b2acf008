#include "host/reference/thin_film.hpp"

#include "host/reference/microfacet.hpp"
#include "host/reference/sampling.hpp"

#include <algorithm>
#include <cmath>

namespace stromboli::reference {
namespace {

using glm::dvec3;

/// The eye's curves as sums of Gaussians over the wave number, by Belcour and Barla: areas, centres
/// (per metre) and variances. The first curve has two.
struct Gaussian {
    int curve;
    double area, center, variance;
};
constexpr Gaussian kCurves[] = {
    {0, 5.4856e-13, 1.6810e6, 4.3278e9},
    {0, 9.7470e-14, 2.2399e6, 4.5282e9},
    {1, 4.4201e-13, 1.7953e6, 9.3046e9},
    {2, 5.2481e-13, 2.2084e6, 6.6121e9},
};
constexpr double kWhole = 1.0685e-7; ///< what each curve is without a path difference

/// Columns are the linear sRGB colours of X, Y and Z.
const glm::dmat3 kRgbOfXyz{{3.2404542, -0.9692660, 0.0556434},
                           {-1.5371385, 1.8760108, -0.2040259},
                           {-0.4985314, 0.0415560, 1.0572252}};

/// What the channels see of the interference of waves whose paths differ by so many metres, and
/// whose phases by `shift` beside that: the Fourier transform of the curves.
dvec3 interference(double path, const dvec3& shift) {
    const double k = 2 * kPi * path;
    dvec3 xyz(0.0);
    for (const Gaussian& g : kCurves)
        xyz[g.curve] += g.area * std::sqrt(2 * kPi * g.variance) * std::exp(-g.variance * k * k) *
                        std::cos(g.center * k + shift[g.curve]);
    return kRgbOfXyz * (xyz / kWhole);
}

/// Schlick's term between two indices, at the cosine on the side of the first.
double schlickBetween(double cosine, double from, double to) {
    const double f0 = square((to - from) / (to + from));
    return f0 + (1 - f0) * std::pow(1 - cosine, 5);
}

} // namespace

dvec3 ThinFilm::reflectance(double cosine, const dvec3& f0) const {
    const double sine2 = (1 - cosine * cosine) / (index * index); // Snell's law
    if (sine2 >= 1) return dvec3(1.0);
    const double inside = std::sqrt(1 - sine2);
    const double top = schlickBetween(cosine, 1, index), through = 1 - top;
    const double path = 2 * index * thickness * 1e-9 * inside;
    dvec3 amplitude, first, sum, shift;
    // The extension's bounds of reflectances: the index of the surface, and the sum over
    // reflections inside the film, stay finite where everything is reflected.
    for (int c = 0; c < 3; ++c) {
        const double root = std::sqrt(std::min(f0[c] + 1e-4, 0.9999));
        const double surface = (1 + root) / (1 - root); // the index that reflects f0 in air
        const double bottom = schlickBetween(inside, index, surface);
        // Against light that the top reflects, the phase of what comes back from the surface is
        // turned by half a wave, and by another half where the surface is less dense than the film.
        shift[c] = (index < 1 ? 0 : kPi) + (surface < index ? kPi : 0);
        const double both = std::clamp(top * bottom, 1e-5, 0.9999);
        const double reflectedInside = square(through) * bottom / (1 - both);
        amplitude[c] = std::sqrt(both);
        first[c] = reflectedInside - through;
        sum[c] = top + reflectedInside;
    }
    dvec3 factor = first;
    for (int order = 1; order <= 2; ++order) {
        factor *= amplitude;
        sum += 2.0 * factor * interference(order * path, double(order) * shift);
    }
    return glm::clamp(sum, 0.0, 1.0);
}

} // namespace stromboli::reference
