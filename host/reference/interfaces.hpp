#pragma once

#include "host/reference/bsdf.hpp"

namespace stromboli::reference {

// --- Conductors and dielectrics ------------------------------------------------------------------

// Conductors, rough and thin dielectrics: docs/theory/surfaces.md, "Surfaces". All directions are
// unit vectors in the frame of the shading normal. entering: wo is outside of what the surface
// bounds. u: three independent numbers in [0, 1).

/// Probability with which samples are reflected: by what is reflected and transmitted.
double shareOfReflection(const glm::dvec3& reflected, const glm::dvec3& transmitted);

BsdfSample sampleConductor(const Material& m, const glm::dvec3& wo,
                           const ShadingConventions& conventions);
BsdfSample sampleThinDielectric(const Material& m, const glm::dvec3& wo, double u);

BsdfValue evaluateFacetConductor(const Material& m, const glm::dvec3& wo, const glm::dvec3& wi,
                                 const ShadingConventions& conventions);
BsdfSample sampleFacetConductor(const Material& m, const glm::dvec3& wo, const glm::dvec3& u,
                                const ShadingConventions& conventions);

BsdfValue evaluateFacetDielectric(const Material& m, const glm::dvec3& wo, bool entering,
                                  const glm::dvec3& wi, const ShadingConventions& conventions);
BsdfSample sampleFacetDielectric(const Material& m, const glm::dvec3& wo, bool entering,
                                 const glm::dvec3& u, const ShadingConventions& conventions);

/// Whether the lobe of facets is too narrow for light samples to find.
bool hasNarrowFacets(const Material& m);

// --- Plastic -------------------------------------------------------------------------------------

// A diffuse base under the interface of a dielectric: docs/theory/surfaces.md, "Plastic". All
// directions are unit vectors in the frame of the shading normal. u: three independent numbers in
// [0, 1).

BsdfValue evaluatePlastic(const Material& m, const glm::dvec3& wo, const glm::dvec3& wi,
                          const ShadingConventions& conventions);
BsdfSample samplePlastic(const Material& m, const glm::dvec3& wo, const glm::dvec3& u,
                         const ShadingConventions& conventions);

} // namespace stromboli::reference
