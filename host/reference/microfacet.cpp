#include "host/reference/microfacet.hpp"

#include "host/reference/fresnel.hpp"
#include "host/reference/sampling.hpp"

#include <cmath>

namespace stromboli::reference {

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
