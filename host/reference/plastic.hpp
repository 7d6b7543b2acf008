#pragma once

#include "host/reference/bsdf.hpp"

namespace stromboli::reference {

// A diffuse base under the interface of a dielectric: docs/estimator.md, "Plastic". All directions
// are unit vectors in the frame of the shading normal. u: three independent numbers in [0, 1).

BsdfValue evaluatePlastic(const Material& m, const glm::dvec3& wo, const glm::dvec3& wi,
                          const ShadingConventions& conventions);
BsdfSample samplePlastic(const Material& m, const glm::dvec3& wo, const glm::dvec3& u,
                         const ShadingConventions& conventions);

} // namespace stromboli::reference
