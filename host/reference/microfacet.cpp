#include "host/reference/microfacet.hpp"

#include "host/reference/sampling.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

namespace stromboli::reference {

// --- Fresnel's equations -------------------------------------------------------------------------

namespace {

/// Mean over both polarisations of |amplitude|^2 (Born and Wolf, section 1.5.2); index of the far
/// side relative to the near one, cosines of incidence and transmission.
template <class Number>
double unpolarised(double cosine, Number index, Number cosTransmitted) {
    const Number s = (cosine - index * cosTransmitted) / (cosine + index * cosTransmitted);
    const Number p = (index * cosine - cosTransmitted) / (index * cosine + cosTransmitted);
    return 0.5 * (std::norm(s) + std::norm(p));
}

} // namespace

Interface dielectric(double cosine, double eta) {
    const double sine2 = eta * eta * std::max(1 - cosine * cosine, 0.0);
    if (sine2 >= 1) return {};
    const double cosTransmitted = std::sqrt(1 - sine2);
    return {unpolarised(cosine, 1 / eta, cosTransmitted), cosTransmitted, false};
}

glm::dvec3 conductor(double cosine, const glm::dvec3& eta, const glm::dvec3& k) {
    glm::dvec3 reflectance;
    for (int c = 0; c < 3; ++c) {
        const std::complex<double> index(eta[c], k[c]);
        const double sine2 = std::max(1 - cosine * cosine, 0.0);
        reflectance[c] = unpolarised(cosine, index, std::sqrt(1.0 - sine2 / (index * index)));
    }
    return reflectance;
}

glm::dvec3 approximateConductor(double c, const glm::dvec3& eta, const glm::dvec3& k) {
    const glm::dvec3 s = eta * eta + k * k, e = 2 * c * eta;
    const glm::dvec3 rs = (s - e + c * c) / (s + e + c * c);
    const glm::dvec3 rp = (s * c * c - e + 1.0) / (s * c * c + e + 1.0);
    return 0.5 * (rs + rp);
}

double schlick(double cosine, double ior) {
    const double r = (1 - ior) / (1 + ior), r0 = r * r;
    return r0 + (1 - r0) * std::pow(1 - cosine, 5);
}

// --- GGX -----------------------------------------------------------------------------------------

double Ggx::density(const glm::dvec3& h) const {
    if (!(h.z > 0)) return 0;
    const double cosine2 = h.z * h.z;
    // tan^2 (cos^2 phi / alphaX^2 + sin^2 phi / alphaY^2)
    const double stretched = (square(h.x / alphaX) + square(h.y / alphaY)) / cosine2;
    return 1 / (kPi * alphaX * alphaY * square(cosine2) * square(1 + stretched));
}

double Ggx::lambda(const glm::dvec3& w) const {
    const double slope2 = (square(alphaX * w.x) + square(alphaY * w.y)) / square(w.z);
    return (std::sqrt(1 + slope2) - 1) / 2;
}

double Ggx::visibleFromBoth(const glm::dvec3& wo, const glm::dvec3& wi) const {
    return 1 / (1 + lambda(wo) + lambda(wi));
}

double Ggx::visibleDensity(const glm::dvec3& wo, const glm::dvec3& h) const {
    const double cosine = glm::dot(wo, h);
    if (!(cosine > 0)) return 0;
    return density(h) * cosine / (wo.z * (1 + lambda(wo)));
}

glm::dvec3 Ggx::sampleVisible(const glm::dvec3& wo, double u, double v) const {
    // The view of a hemisphere: a disk of which the lower part is shortened by the view's cosine.
    const Frame view(glm::normalize(glm::dvec3(alphaX * wo.x, alphaY * wo.y, wo.z)));
    const glm::dvec3 side = glm::length(glm::cross(glm::dvec3(0, 0, 1), view.z)) > 0
                                ? glm::normalize(glm::cross(glm::dvec3(0, 0, 1), view.z))
                                : view.x;
    const glm::dvec3 up = glm::cross(view.z, side);
    const double r = std::sqrt(u), x = r * std::cos(2 * kPi * v), s = (1 + view.z.z) / 2;
    const double chord = std::sqrt(std::max(1 - x * x, 0.0));
    const double y = (1 - s) * chord + s * r * std::sin(2 * kPi * v);
    const glm::dvec3 n = x * side + y * up + std::sqrt(std::max(1 - x * x - y * y, 0.0)) * view.z;
    return glm::normalize(glm::dvec3(alphaX * n.x, alphaY * n.y, std::max(n.z, 1e-300)));
}

// --- Microfacets of either distribution ----------------------------------------------------------

namespace {

/// x between low and high such that increasing(x) = value, to the last digits: Newton's steps, and
/// halves where one of them leaves the bracket. slope(x): increasing's derivative.
template <class F, class Slope>
double solve(double low, double high, double value, F&& increasing, Slope&& slope) {
    double x = (low + high) / 2;
    for (int i = 0; i < 60; ++i) { // as many as halves alone would take
        const double off = increasing(x) - value;
        (off < 0 ? low : high) = x;
        double next = x - off / slope(x);
        if (!(next >= low && next <= high)) next = (low + high) / 2;
        const bool found = std::abs(next - x) <= 1e-16;
        x = next;
        if (found) break;
    }
    return x;
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
    const double erfLow = std::erf(low), expLow = std::exp(-low * low);
    const auto share = [&](double x) {
        return cosine * std::sqrt(kPi) * (std::erf(x) - erfLow) +
               sine * (expLow - std::exp(-x * x));
    };
    const auto shareSlope = [&](double x) { return 2 * std::exp(-x * x) * (cosine + sine * x); };
    const double along = solve(low, kSteepest, u * share(kSteepest), share, shareSlope);
    const double across = solve(
        -kSteepest, kSteepest, 2 * v - 1, [](double x) { return std::erf(x); },
        [](double x) { return 2 / std::sqrt(kPi) * std::exp(-x * x); });
    const double c = sine > 0 ? view.x / sine : 1, s = sine > 0 ? view.y / sine : 0;
    return glm::normalize(
        glm::dvec3(alphaX * (c * along - s * across), alphaY * (s * along + c * across), 1));
}

// --- Beckmann's conductor ------------------------------------------------------------------------

double beckmannD(const glm::dvec3& h, double alpha) {
    if (!(h.z > 0)) return 0;
    const double cosine2 = h.z * h.z;
    const double tangent2 = (h.x * h.x + h.y * h.y) / cosine2;
    return std::exp(-tangent2 / (alpha * alpha)) / (kPi * alpha * alpha * cosine2 * cosine2);
}

double smithLambda(const glm::dvec3& w, double alpha, const ShadingConventions& conventions) {
    const double sine = std::hypot(w.x, w.y);
    if (sine == 0) return 0;
    const double a = w.z / (alpha * sine);
    if (!conventions.exactLambda) return (std::erf(a) - 1 + std::exp(-a * a) / (a * kPi)) / 2;
    return -std::erfc(a) / 2 + std::exp(-a * a) / (2 * a * std::sqrt(kPi));
}

glm::dvec3 sampleBeckmann(double alpha, double u, double v) {
    const double tangent2 = -alpha * alpha * std::log1p(-u);
    const double cosine = 1 / std::sqrt(1 + tangent2);
    const double sine = std::sqrt(tangent2) * cosine;
    return {sine * std::cos(2 * kPi * v), sine * std::sin(2 * kPi * v), cosine};
}

glm::dvec3 microfacet(const Material& m, const glm::dvec3& wo, const glm::dvec3& wi,
                      const ShadingConventions& conventions) {
    if (!(wo.z > 0 && wi.z > 0)) return glm::dvec3(0.0);
    const glm::dvec3 h = glm::normalize(wo + wi);
    const double alpha = m.facets.alpha.x;
    const double g =
        1 / (1 + smithLambda(wo, alpha, conventions) + smithLambda(wi, alpha, conventions));
    const glm::dvec3 f = conventions.exactFresnel ? conductor(glm::dot(wi, h), m.eta, m.k)
                                                  : approximateConductor(wi.z, m.eta, m.k);
    return f * (g * beckmannD(h, alpha) / (4 * wo.z * wi.z));
}

double microfacetDensity(double alpha, const glm::dvec3& wo, const glm::dvec3& wi) {
    const glm::dvec3 h = glm::normalize(wo + wi);
    return beckmannD(h, alpha) * h.z / (4 * glm::dot(wo, h));
}

} // namespace stromboli::reference
