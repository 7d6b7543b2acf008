#pragma once

#include "host/reference/surface.hpp"

#include <glm/glm.hpp>

namespace stromboli::reference {

// Directions are unit vectors in the frame of the shading normal (z); alpha > 0 is the Beckmann
// roughness.

/// Beckmann's density of microfacet normals: its integral times cos over the hemisphere is 1.
double beckmannD(const glm::dvec3& h, double alpha);

/// Smith's Lambda for the Beckmann distribution, exact or not. w.z > 0.
double smithLambda(const glm::dvec3& w, double alpha, const ShadingConventions& conventions);

/// Microfacet normal with density beckmannD(h) h.z per solid angle; u, v uniform in [0, 1).
glm::dvec3 sampleBeckmann(double alpha, double u, double v);

/// f of the conductor `m`; 0 where wo or wi is not above the surface.
glm::dvec3 microfacet(const Material& m, const glm::dvec3& wo, const glm::dvec3& wi,
                      const ShadingConventions& conventions);

/// Density per solid angle of wi = wo reflected about sampleBeckmann(). wo.z > 0. The integral over
/// the upper hemisphere is below 1 by the share of directions that end up below.
double microfacetDensity(double alpha, const glm::dvec3& wo, const glm::dvec3& wi);

} // namespace stromboli::reference
