#include "host/kernel/facet_terms.hpp"

#include <algorithm>
#include <array>
#include <cmath>

namespace stromboli {

namespace {

constexpr double kPi = 3.14159265358979323846;

double square(double x) {
    return x * x;
}

/// Unpolarised reflectance of a plane between dielectrics. eta: index on the incident side over
/// that on the other; cosTransmitted: out, 0 in total reflection.
double fresnel(double cosine, double eta, double& cosTransmitted) {
    const double cos2 = 1 - eta * eta * (1 - square(cosine));
    cosTransmitted = std::sqrt(std::max(cos2, 0.0));
    if (cos2 <= 0) return 1;
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
        const double c = std::abs(cosine), sine = std::sqrt(std::max(1 - c * c, 0.0)) * alpha;
        if (distribution == FacetDistribution::Ggx)
            return (c + std::sqrt(square(sine) + square(c))) / 2;
        if (sine == 0) return c;
        return sine * beckmannArea(c / sine);
    }
    /// Squared tangent of normals such that a share u of the surface has smaller ones.
    double tangent2(double u) const {
        const double quantile =
            distribution == FacetDistribution::Ggx ? u / (1 - u) : -std::log1p(-u);
        return alpha * alpha * quantile;
    }
    /// The share of the facets seen from one direction, of that area, that the other one meets.
    double lit(double seen, double cosine, double otherCosine) const {
        const double other = std::abs(otherCosine), otherArea = area(otherCosine);
        if (masking == FacetMasking::Separable) return other / otherArea;
        return other * seen / (other * seen + cosine * (otherArea - other));
    }
};

/// How many rings of normals are summed: integrals over views need fewer.
constexpr int kCoarse = 64, kFine = 192;

/// What becomes of light at a facet.
enum class Way { Reflected, Transmitted };

constexpr int kSectors = 48;

/// Of the middles of the sectors of half a ring.
std::array<double, kSectors> sectorCosines() {
    std::array<double, kSectors> cosines;
    for (int j = 0; j < kSectors; ++j)
        cosines[size_t(j)] = std::cos(kPi * (j + 0.5) / kSectors);
    return cosines;
}

/// The share of light from a direction that goes this way after one scattering.
template <Way way>
double scatteredBy(const Microfacets& facets, double eta, double cosine, int rings) {
    static const std::array<double, kSectors> cosines = sectorCosines();
    const double sine = std::sqrt(std::max(1 - cosine * cosine, 0.0)), area = facets.area(cosine);
    double sum = 0;
    for (int i = 0; i < rings; ++i) {
        // A substitution that makes the tails of GGX smooth: visible normals have 1 / cos more of
        // them.
        const double left = 1 - (i + 0.5) / rings, ring = 2 * left / rings;
        const double z = 1 / std::sqrt(1 + facets.tangent2(1 - left * left));
        const double across = std::sqrt(1 - z * z);
        for (const double sector : cosines) { // half of them: the others are their mirror images
            const double x = across * sector;
            const double cosO = sine * x + cosine * z;
            if (cosO <= 0) continue;
            double cosTransmitted = 0;
            const double f = fresnel(std::min(cosO, 1.0), eta, cosTransmitted);
            const double seen = ring / kSectors * cosO / (z * area);
            if constexpr (way == Way::Reflected) {
                const double reflectedZ = 2 * cosO * z - cosine;
                if (reflectedZ > 0) sum += seen * f * facets.lit(area, cosine, reflectedZ);
            } else {
                const double transmittedZ = (eta * cosO - cosTransmitted) * z - eta * cosine;
                if (f < 1 && transmittedZ < 0)
                    sum += seen * (1 - f) * facets.lit(area, cosine, transmittedZ);
            }
        }
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
            sum += 2 * mu * scatteredBy<Way::Reflected>(shape, ior, mu, kCoarse);
        }
        return sum / views;
    }
    // Up to the critical angle and from there on: what narrow facets reflect ends there like a
    // square root.
    const double critical = std::sqrt(std::max(1 - 1 / square(ior), 0.0));
    constexpr int kViews = 32;
    double sum = 0;
    for (int i = 0; i < kViews; ++i) {
        const double s = (i + 0.5) / kViews;
        for (const double end : {0.0, 1.0}) {
            const double mu = critical + (end - critical) * s * s;
            sum += 2 * mu * scatteredBy<Way::Reflected>(shape, ior, mu, kCoarse) * 2 * s *
                   std::abs(end - critical) / kViews;
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
        at[i] = scatteredBy<Way::Transmitted>(shape, 1 / ior, mu, kFine);
    }
    std::array<glm::vec4, kPieces> pieces;
    for (size_t i = 0; i < kPieces; ++i)
        pieces[i] = cubic(at[3 * i], at[3 * i + 1], at[3 * i + 2], at[3 * i + 3]);
    return pieces;
}

} // namespace stromboli
