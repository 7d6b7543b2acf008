#pragma once

#include "scene/model/material.hpp"

#include <glm/glm.hpp>

namespace stromboli::reference {

/// Microfacets of either distribution, stretched along the axes of the frame of the shading normal
/// (z), with Smith's masking and shadowing. Directions are unit vectors.
struct FacetModel {
    FacetDistribution distribution;
    FacetMasking masking;
    double alphaX, alphaY; ///< > 0

    explicit FacetModel(const Material& material);

    /// Density of normals: its integral times cos over the hemisphere is 1.
    double density(const glm::dvec3& h) const;
    /// Smith's Lambda; the sign of w.z has no meaning. exact: else
    /// ShadingConventions::exactLambda's other form of Beckmann's.
    double lambda(const glm::dvec3& w, bool exact = true) const;
    /// The share of facets seen from wo and lit from wi, as `masking` says.
    double visibleFromBoth(const glm::dvec3& wo, const glm::dvec3& wi, bool exact = true) const;
    /// Density, by solid angle, of the normals seen from wo, wo.z > 0.
    double visibleDensity(const glm::dvec3& wo, const glm::dvec3& h) const;
    /// A normal of that density. u, v: uniform in [0, 1).
    glm::dvec3 sampleVisible(const glm::dvec3& wo, double u, double v) const;
};

} // namespace stromboli::reference
