#include "host/reference/fresnel.hpp"

#include <algorithm>
#include <cmath>
#include <complex>

namespace stromboli::reference {
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

} // namespace stromboli::reference
