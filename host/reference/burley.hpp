#pragma once

#include "host/reference/bsdf.hpp"

namespace stromboli::reference {

// Burley's principled BSDF as Mitsuba 3 has it: docs/theory/surfaces.md, "Burley". All directions
// are unit vectors in the frame of the shading normal; wo.z > 0, or nothing scatters. entering: wo
// is outside of what the surface bounds.

/// gpu::LOBE_ bits.
uint32_t burleyLobes(const BurleyParameters& p);

BsdfValue evaluateBurley(const BurleyParameters& p, const glm::dvec3& wo, bool entering,
                         const glm::dvec3& wi);

/// u: three independent numbers in [0, 1).
BsdfSample sampleBurley(const BurleyParameters& p, const glm::dvec3& wo, bool entering,
                        const glm::dvec3& u);

/// Whether some lobe is too narrow for light samples to find.
bool isNarrow(const BurleyParameters& p);

} // namespace stromboli::reference
