#pragma once

#include "host/reference/bsdf.hpp"

namespace stromboli::reference {

// glTF's metallic-roughness material and its extensions: docs/theory/surfaces.md, "Principled". All
// directions are unit vectors in the frame of the shading normal; wo.z > 0, or nothing scatters.
// entering: wo is outside of what the surface bounds.

/// gpu::LOBE_ bits.
uint32_t principledLobes(const PrincipledParameters& p);

/// coat: unit normal of the clear coat.
BsdfValue evaluatePrincipled(const PrincipledParameters& p, const glm::dvec3& wo, bool entering,
                             const glm::dvec3& wi, const glm::dvec3& coat = {0, 0, 1});

/// u: three independent numbers in [0, 1).
BsdfSample samplePrincipled(const PrincipledParameters& p, const glm::dvec3& wo, bool entering,
                            const glm::dvec3& u, const glm::dvec3& coat = {0, 0, 1});

/// Clear glass, which is a plane (PrincipledParameters::isClear). u: in [0, 1), chooses between
/// reflection and transmission.
BsdfSample sampleClearPrincipled(const PrincipledParameters& p, const glm::dvec3& wo, bool entering,
                                 double u);

/// Per metre, behind a surface that light goes through into a volume; 0 where it does not.
glm::dvec3 absorption(const PrincipledParameters& p);

} // namespace stromboli::reference
