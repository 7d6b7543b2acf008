#include "host/reference/ggx.hpp"

#include "host/reference/arithmetic.hpp"
#include "host/reference/sampling.hpp"

#include <algorithm>
#include <cmath>

namespace stromboli::reference {
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

} // namespace stromboli::reference
