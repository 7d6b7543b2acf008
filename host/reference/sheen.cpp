#include "host/reference/sheen.hpp"

#include "host/reference/sampling.hpp"
#include "shaders/shared/bsdf_types.h"

#include <algorithm>
#include <cmath>

namespace stromboli::reference {
namespace {

/// Estevez and Kulla 2017, equation 3 and table 1.
double sheenLambda(double cosine, double alpha) {
    const double t = (1 - alpha) * (1 - alpha);
    const auto l = [&](double x) {
        const double a = t * 25.3245 + (1 - t) * 21.5473, b = t * 3.32435 + (1 - t) * 3.82987;
        const double c = t * 0.16801 + (1 - t) * 0.19823, d = t * -1.27393 + (1 - t) * -1.97760;
        return a / (1 + b * std::pow(x, c)) + d * x + t * -4.85967 + (1 - t) * -4.32054;
    };
    return std::exp(cosine < 0.5 ? l(cosine) : 2 * l(0.5) - l(1 - cosine));
}

} // namespace

double sheen(double alpha, const glm::dvec3& wo, const glm::dvec3& wi) {
    const glm::dvec3 h = glm::normalize(wo + wi);
    const double d = (2 + 1 / alpha) * std::pow(std::hypot(h.x, h.y), 1 / alpha) / (2 * kPi);
    const double least = gpu::LEAST_SHEEN_COSINE;
    const double cosO = std::clamp(wo.z, least, 1.0), cosI = std::clamp(wi.z, least, 1.0);
    const double g = 1 / (1 + sheenLambda(cosO, alpha) + sheenLambda(cosI, alpha));
    return d * g / (4 * cosO * cosI);
}

} // namespace stromboli::reference
