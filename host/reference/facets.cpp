#include "host/reference/facets.hpp"

#include "host/reference/arithmetic.hpp"
#include "host/reference/ggx.hpp"
#include "host/reference/sampling.hpp"

#include <algorithm>
#include <cmath>

namespace stromboli::reference {
namespace {

/// x such that increasing(x) = value, to the last digit.
template <class F>
double solve(double low, double high, double value, F&& increasing) {
    for (int i = 0; i < 60; ++i) {
        const double middle = (low + high) / 2;
        (increasing(middle) < value ? low : high) = middle;
    }
    return (low + high) / 2;
}

/// No slope of Beckmann's distribution of alpha 1 is above it: exp(-6^2) is 2e-16.
constexpr double kSteepest = 6;

} // namespace

FacetModel::FacetModel(const Material& material)
    : distribution(material.facets.distribution), masking(material.facets.masking),
      alphaX(material.facetAlpha().x), alphaY(material.facetAlpha().y) {}

double FacetModel::density(const glm::dvec3& h) const {
    if (distribution == FacetDistribution::Ggx) return Ggx{alphaX, alphaY}.density(h);
    if (!(h.z > 0)) return 0;
    const double slope2 = (square(h.x / alphaX) + square(h.y / alphaY)) / square(h.z);
    return std::exp(-slope2) / (kPi * alphaX * alphaY * square(square(h.z)));
}

double FacetModel::lambda(const glm::dvec3& w, bool exact) const {
    if (distribution == FacetDistribution::Ggx) return Ggx{alphaX, alphaY}.lambda(w);
    const double sine = std::hypot(alphaX * w.x, alphaY * w.y);
    if (sine == 0) return 0;
    const double a = std::abs(w.z) / sine;
    const double root = exact ? std::sqrt(kPi) : kPi;
    return std::exp(-a * a) / (2 * a * root) - std::erfc(a) / 2;
}

double FacetModel::visibleFromBoth(const glm::dvec3& wo, const glm::dvec3& wi, bool exact) const {
    const double atO = lambda(wo, exact), atI = lambda(wi, exact);
    if (masking == FacetMasking::Separable) return 1 / ((1 + atO) * (1 + atI));
    return 1 / (1 + atO + atI);
}

double FacetModel::visibleDensity(const glm::dvec3& wo, const glm::dvec3& h) const {
    const double cosine = glm::dot(wo, h);
    if (!(cosine > 0)) return 0;
    return density(h) * cosine / (wo.z * (1 + lambda(wo)));
}

/// Beckmann: where alpha is 1, the slope across the view is normal; that along it, x, has the
/// density (x sin + cos) exp(-x^2), x > -cos / sin, of which the integral is inverted (Heitz and
/// d'Eon 2014).
glm::dvec3 FacetModel::sampleVisible(const glm::dvec3& wo, double u, double v) const {
    if (distribution == FacetDistribution::Ggx) return Ggx{alphaX, alphaY}.sampleVisible(wo, u, v);
    const glm::dvec3 view = glm::normalize(glm::dvec3(alphaX * wo.x, alphaY * wo.y, wo.z));
    const double sine = std::hypot(view.x, view.y), cosine = view.z;
    const double low = sine * kSteepest > cosine ? -cosine / sine : -kSteepest;
    const auto share = [&](double x) {
        return cosine * std::sqrt(kPi) * (std::erf(x) - std::erf(low)) +
               sine * (std::exp(-low * low) - std::exp(-x * x));
    };
    const double along = solve(low, kSteepest, u * share(kSteepest), share);
    const double across =
        solve(-kSteepest, kSteepest, 2 * v - 1, [](double x) { return std::erf(x); });
    const double c = sine > 0 ? view.x / sine : 1, s = sine > 0 ? view.y / sine : 0;
    return glm::normalize(
        glm::dvec3(alphaX * (c * along - s * across), alphaY * (s * along + c * across), 1));
}

} // namespace stromboli::reference
