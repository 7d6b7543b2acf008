#pragma once

#include "scene/model/material.hpp"
#include "shaders/shared/bsdf_types.h"

#include <array>

namespace stromboli {

/// (a (1 + erf(a)) + exp(-a^2) / sqrt(pi)) / 2 for a >= 0, to within 3e-9: the area of Beckmann's
/// facets that is seen at the angle t from the normal is that of a = 1 / (alpha tan(t)), times
/// alpha sin(t). A material's tables ask for it a million times.
double beckmannArea(double a);

// What the interface of a dielectric does with light that is scattered once by it: the terms that
// plastic is made of (docs/theory/surfaces.md, "Plastic"). ior: index under the interface over the
// index above it. facets: their distribution and masking; alpha is stated beside them.

/// The share of diffuse light from below that a smooth interface sends back. A closed form.
double internalReflectance(double ior);

/// The share of diffuse light from below that an interface of microfacets sends back; by
/// quadrature, right to 5e-4. views: those of Material::internalViews.
double internalReflectance(double ior, double alpha, const Facets& facets, uint32_t views = 0);

/// The share of light from above that an interface of microfacets lets through, as the kernel looks
/// it up: gpu::TRANSMITTANCE_PIECES says how. Right to 5e-4; to 0.04 where the denser side is above
/// (ior below 1) and narrow facets begin to reflect all of a sudden.
std::array<glm::vec4, gpu::TRANSMITTANCE_PIECES> transmittanceTable(double ior, double alpha,
                                                                    const Facets& facets);

} // namespace stromboli
