#include "host/stress/metal_furnace.hpp"

#include "host/reference/microfacet.hpp"

#include <cmath>
#include <vector>

namespace stromboli::stress {
namespace {

constexpr int kNodes = 64;     ///< of the cosine
constexpr int kAzimuths = 256; ///< midpoints; the integrand is periodic and smooth

struct Quadrature {
    std::vector<double> at, weight; ///< on [0, 1]
};

/// Newton's method on the Legendre polynomial of degree kNodes.
Quadrature gaussLegendre() {
    Quadrature q;
    for (int i = 0; i < kNodes; ++i) {
        double x = std::cos(M_PI * (i + 0.75) / (kNodes + 0.5)), slope = 1;
        for (int step = 0; step < 50; ++step) {
            double p = 1, before = 0;
            for (int k = 0; k < kNodes; ++k) {
                const double next = ((2 * k + 1) * x * p - k * before) / (k + 1);
                before = p, p = next;
            }
            slope = kNodes * (x * p - before) / (x * x - 1);
            x -= p / slope;
        }
        q.at.push_back((1 + x) / 2);
        q.weight.push_back(1 / ((1 - x * x) * slope * slope));
    }
    return q;
}

/// Integral over azimuths of f(mu, w) w.z, w.z = nu.
double kernel(const Material& m, double mu, double nu) {
    const glm::dvec3 wo(std::sqrt(1 - mu * mu), 0, mu);
    double sum = 0;
    for (int i = 0; i < kAzimuths; ++i) {
        const double phi = 2 * M_PI * (i + 0.5) / kAzimuths, sine = std::sqrt(1 - nu * nu);
        const glm::dvec3 wi(sine * std::cos(phi), sine * std::sin(phi), nu);
        sum += reference::microfacet(m, wo, wi, {}).x;
    }
    return sum * nu * 2 * M_PI / kAzimuths;
}

} // namespace

double metalFurnace(const Material& material, double cosine) {
    const Quadrature q = gaussLegendre();
    std::vector<std::vector<double>> transport(kNodes, std::vector<double>(kNodes));
    for (int i = 0; i < kNodes; ++i)
        for (int j = 0; j < kNodes; ++j)
            transport[size_t(i)][size_t(j)] =
                q.weight[size_t(j)] * kernel(material, q.at[size_t(i)], q.at[size_t(j)]);
    // One more scattering a step; each keeps less than 0.95 of the light.
    const double emission = material.emission.x;
    std::vector<double> radiance(kNodes, emission);
    for (int step = 0; step < 400; ++step) {
        std::vector<double> next(kNodes, emission);
        for (size_t i = 0; i < kNodes; ++i)
            for (size_t j = 0; j < kNodes; ++j)
                next[i] += transport[i][j] * radiance[j];
        radiance = next;
    }
    double result = emission;
    for (size_t j = 0; j < kNodes; ++j)
        result += q.weight[j] * kernel(material, cosine, q.at[j]) * radiance[j];
    return result;
}

} // namespace stromboli::stress
