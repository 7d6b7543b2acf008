#include "host/kernel/facet_terms.hpp"

#include "host/core/quadrature.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

namespace stromboli {

namespace {

constexpr double kPi = 3.14159265358979323846;

double square(double x) {
    return x * x;
}

/// Unpolarised reflectance of a plane between dielectrics where it is not total. eta: index on the
/// incident side over that on the other.
double fresnel(double cosine, double eta, double cosTransmitted) {
    const double s = (eta * cosine - cosTransmitted) / (eta * cosine + cosTransmitted);
    const double p = (cosine - eta * cosTransmitted) / (cosine + eta * cosTransmitted);
    return (s * s + p * p) / 2;
}

/// beckmannArea() by the first three terms of Taylor's series at the nearest of 1025 places. The
/// next one is below 3e-9, as the third derivative is below 0.49.
class BeckmannArea {
  public:
    BeckmannArea() {
        for (size_t i = 0; i <= kSteps; ++i) {
            const double a = double(i) / kPerUnit, sides = 1 + std::erf(a);
            const double bell = std::exp(-a * a) / std::sqrt(kPi);
            terms_[i] = {(a * sides + bell) / 2, sides / 2, bell / 2};
        }
    }
    double operator()(double a) const {
        if (!(a < kEnd)) return a; // 1 - erf(6) is 2e-17
        const auto i = size_t(a * kPerUnit + 0.5);
        const double d = a - double(i) / kPerUnit;
        return terms_[i][0] + d * (terms_[i][1] + d * terms_[i][2]);
    }

  private:
    static constexpr size_t kSteps = 1024;
    static constexpr double kEnd = 6, kPerUnit = kSteps / kEnd;
    std::array<std::array<double, 3>, kSteps + 1> terms_;
};

/// Isotropic microfacets. Directions by cosine: the projected area that is seen from one is |cos|
/// (1 + Lambda), with Smith's Lambda.
struct Microfacets {
    double alpha;
    FacetDistribution distribution;
    FacetMasking masking;

    double area(double cosine) const {
        areas({&cosine, 1}, {&cosine, 1});
        return cosine;
    }
    /// Those seen from several directions. In loops that compilers make vectors of, but for the
    /// look-up in a table.
    void areas(std::span<const double> cosines, std::span<double> seen) const {
        const size_t count = cosines.size();
        if (distribution == FacetDistribution::Ggx) {
            for (size_t i = 0; i < count; ++i) {
                const double c = std::abs(cosines[i]);
                const double sine = std::sqrt(std::max(1 - c * c, 0.0)) * alpha;
                seen[i] = (c + std::sqrt(square(sine) + square(c))) / 2;
            }
            return;
        }
        std::array<double, kMostAreas> sines, quotients;
        for (size_t i = 0; i < count; ++i) {
            const double c = std::abs(cosines[i]);
            sines[i] = std::sqrt(std::max(1 - c * c, 0.0)) * alpha;
            quotients[i] = c / sines[i]; // infinite along the normal, which sees all of it
            seen[i] = c;
        }
        for (size_t i = 0; i < count; ++i)
            if (sines[i] != 0) seen[i] = sines[i] * beckmannArea(quotients[i]);
    }
    static constexpr size_t kMostAreas = 48;

    /// Squared tangent of normals such that a share u of the surface has smaller ones.
    double tangent2(double u) const {
        const double quantile =
            distribution == FacetDistribution::Ggx ? u / (1 - u) : -std::log1p(-u);
        return alpha * alpha * quantile;
    }
    /// The share of the facets seen from one direction, of that area, that the other one meets, of
    /// which the area is given as well.
    double lit(double seen, double cosine, double otherCosine, double otherArea) const {
        const double other = std::abs(otherCosine);
        if (masking == FacetMasking::Separable) return other / otherArea;
        return other * seen / (other * seen + cosine * (otherArea - other));
    }
};

/// Rings of normals that are summed for the light that goes through, by Gauss and Legendre's rule.
/// Of 192 rings of one width sums are four times as far off (docs/results.md, "Start-up").
const Quadrature& ringsOfTransmitted() {
    static const Quadrature rings = gaussLegendre(32);
    return rings;
}
/// Likewise for what is reflected, of which some is so totally: at the edge of that light, rings of
/// one width are nearer.
const Quadrature& ringsOfReflected() {
    static const Quadrature rings = midpoints(48);
    return rings;
}

constexpr size_t kSectors = Microfacets::kMostAreas;
using OfSectors = std::array<double, kSectors>;

/// Of the middles of the sectors of half a ring, from the greatest.
OfSectors sectorCosines() {
    OfSectors cosines;
    for (size_t j = 0; j < kSectors; ++j)
        cosines[j] = std::cos(kPi * (double(j) + 0.5) / double(kSectors));
    return cosines;
}

/// What becomes of light at a facet.
enum class Way { Reflected, Transmitted };

/// The share of light from a direction that goes this way after one scattering. eta: index on the
/// side of that direction over that on the other.
template <Way way>
double scatteredBy(const Microfacets& facets, double eta, double cosine, const Quadrature& rings) {
    static const OfSectors cosines = sectorCosines();
    const double sine = std::sqrt(std::max(1 - cosine * cosine, 0.0)), area = facets.area(cosine);
    double sum = 0;
    OfSectors cosO, otherZ, otherArea, shares;
    for (size_t i = 0; i < rings.at.size(); ++i) {
        // A substitution that makes the tails of GGX smooth: visible normals have 1 / cos more of
        // them.
        const double left = rings.at[i], ring = 2 * left * rings.weight[i];
        const double z = 1 / std::sqrt(1 + facets.tangent2(1 - left * left));
        const double across = std::sqrt(1 - z * z);
        // Half of the sectors: the others are their mirror images. They turn away from the
        // direction one after the other.
        size_t count = 0;
        for (; count < kSectors; ++count) {
            const double x = across * cosines[count];
            cosO[count] = sine * x + cosine * z;
            if (cosO[count] <= 0) break;
        }
        for (size_t j = 0; j < count; ++j) {
            const double c = std::min(cosO[j], 1.0), cos2 = 1 - eta * eta * (1 - square(c));
            const double cosTransmitted = std::sqrt(std::max(cos2, 0.0));
            const double f = cos2 <= 0 ? 1 : fresnel(c, eta, cosTransmitted);
            if constexpr (way == Way::Reflected) {
                otherZ[j] = 2 * cosO[j] * z - cosine;
                shares[j] = otherZ[j] > 0 ? f : 0;
            } else {
                otherZ[j] = (eta * cosO[j] - cosTransmitted) * z - eta * cosine;
                shares[j] = otherZ[j] < 0 ? 1 - f : 0;
            }
        }
        facets.areas(std::span(otherZ).first(count), otherArea);
        for (size_t j = 0; j < count; ++j) {
            const double seen = ring / double(kSectors) * cosO[j] / (z * area);
            const double lit = facets.lit(area, cosine, otherZ[j], otherArea[j]);
            shares[j] = shares[j] > 0 ? seen * shares[j] * lit : 0;
        }
        for (size_t j = 0; j < count; ++j)
            sum += shares[j];
    }
    return sum;
}

/// Cubic through the values at 0, 1/3, 2/3 and 1, by rising powers.
glm::vec4 cubic(double a, double b, double c, double d) {
    return {a, (-11 * a + 18 * b - 9 * c + 2 * d) / 2, (18 * a - 45 * b + 36 * c - 9 * d) / 2,
            (-9 * a + 27 * b - 27 * c + 9 * d) / 2};
}

} // namespace

double beckmannArea(double a) {
    static const BeckmannArea area;
    return area(a);
}

/// Walsh 1926; Duntley, "The Optical Properties of Diffusing Materials" (1942), for light from the
/// less dense side. On the other, radiance over the squared index is what is conserved: n^2 (1 -
/// inside) = 1 - outside.
double internalReflectance(double ior) {
    const double n = std::max(ior, 1 / ior), n2 = n * n, n4 = n2 * n2;
    // The terms are of the order of 1 / (n - 1)^2 and cancel; nearer to 1, less than 3e-5 is
    // reflected.
    constexpr double kNearlyEqual = 1e-5;
    if (n - 1 < kNearlyEqual) return 0;
    const double fromOutside =
        0.5 + (n - 1) * (3 * n + 1) / (6 * square(n + 1)) +
        n2 * square(n2 - 1) / std::pow(n2 + 1, 3) * std::log((n - 1) / (n + 1)) -
        2 * n2 * n * (n2 + 2 * n - 1) / ((n2 + 1) * (n4 - 1)) +
        8 * n4 * (n4 + 1) / ((n2 + 1) * square(n4 - 1)) * std::log(n);
    return ior > 1 ? 1 - (1 - fromOutside) / n2 : fromOutside;
}

double internalReflectance(double ior, double alpha, const Facets& facets, uint32_t views) {
    const Microfacets shape{alpha, facets.distribution, facets.masking};
    if (views > 1) {
        double sum = 0;
        for (uint32_t i = 0; i < views; ++i) {
            const double mu = std::max(double(i) / (views - 1), 1e-6);
            sum += 2 * mu * scatteredBy<Way::Reflected>(shape, ior, mu, ringsOfReflected());
        }
        return sum / views;
    }
    // Up to the critical angle and from there on: what narrow facets reflect ends there like a
    // square root.
    const double critical = std::sqrt(std::max(1 - 1 / square(ior), 0.0));
    static const Quadrature towardsEnds = gaussLegendre(12);
    double sum = 0;
    for (size_t i = 0; i < towardsEnds.at.size(); ++i) {
        const double s = towardsEnds.at[i];
        for (const double end : {0.0, 1.0}) {
            const double mu = critical + (end - critical) * s * s;
            sum += 2 * mu * scatteredBy<Way::Reflected>(shape, ior, mu, ringsOfReflected()) * 2 *
                   s * std::abs(end - critical) * towardsEnds.weight[i];
        }
    }
    return sum;
}

std::array<glm::vec4, gpu::TRANSMITTANCE_PIECES> transmittanceTable(double ior, double alpha,
                                                                    const Facets& facets) {
    const Microfacets shape{alpha, facets.distribution, facets.masking};
    constexpr uint32_t kPieces = gpu::TRANSMITTANCE_PIECES;
    std::array<double, 3 * kPieces + 1> at{};
    for (size_t i = 0; i < at.size(); ++i) {
        // A view along the surface (mu = 0) takes the limit.
        const double mu = std::max(square(double(i) / (3 * kPieces)), 1e-9);
        at[i] = scatteredBy<Way::Transmitted>(shape, 1 / ior, mu, ringsOfTransmitted());
    }
    std::array<glm::vec4, kPieces> pieces;
    for (size_t i = 0; i < kPieces; ++i)
        pieces[i] = cubic(at[3 * i], at[3 * i + 1], at[3 * i + 2], at[3 * i + 3]);
    return pieces;
}

} // namespace stromboli
