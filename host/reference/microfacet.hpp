#pragma once

#include "host/reference/surface.hpp"
#include "scene/model/material.hpp"

#include <glm/glm.hpp>

namespace stromboli::reference {

// --- Arithmetic ----------------------------------------------------------------------------------

/// The mean of a colour's channels.
inline double mean(const glm::dvec3& color) {
    return (color.x + color.y + color.z) / 3;
}

inline double square(double x) {
    return x * x;
}

// --- Fresnel's equations -------------------------------------------------------------------------

/// A smooth interface between two dielectrics, seen from the side of the incident ray.
struct Interface {
    double reflectance = 1;    ///< unpolarised; 1 in total reflection
    double cosTransmitted = 0; ///< of the refracted ray to the normal, >= 0
    bool total = true;         ///< total reflection: there is no refracted ray
};

/// cosine: of incidence, in [0, 1]; eta: index of the incident side over that of the other.
Interface dielectric(double cosine, double eta);

/// Unpolarised reflectance of a conductor of index eta + i k against vacuum, per colour channel.
/// cosine: of incidence, in (0, 1].
glm::dvec3 conductor(double cosine, const glm::dvec3& eta, const glm::dvec3& k);

/// An approximation of conductor() for k^2 >> 1.
glm::dvec3 approximateConductor(double cosine, const glm::dvec3& eta, const glm::dvec3& k);

/// Schlick's approximation of a dielectric of index `ior` against vacuum.
double schlick(double cosine, double ior);

// --- GGX -----------------------------------------------------------------------------------------

/// Microfacets with the distribution of Trowbridge and Reitz (GGX), stretched along the axes of the
/// frame of the shading normal (z), with Smith's height-correlated masking and shadowing.
/// Directions are unit vectors.
struct Ggx {
    double alphaX, alphaY; ///< > 0

    /// Density of normals: its integral times cos over the hemisphere is 1. h.z > 0.
    double density(const glm::dvec3& h) const;
    /// Smith's Lambda; the sign of w.z has no meaning.
    double lambda(const glm::dvec3& w) const;
    /// 1 / (1 + Lambda(wo) + Lambda(wi)).
    double visibleFromBoth(const glm::dvec3& wo, const glm::dvec3& wi) const;
    /// Density, by solid angle, of the normals seen from wo, wo.z > 0.
    double visibleDensity(const glm::dvec3& wo, const glm::dvec3& h) const;
    /// A normal of that density (Heitz, "Sampling the GGX Distribution of Visible Normals", 2018).
    /// u, v: uniform in [0, 1).
    glm::dvec3 sampleVisible(const glm::dvec3& wo, double u, double v) const;
};

// --- Microfacets of either distribution ----------------------------------------------------------

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

// --- Beckmann's conductor ------------------------------------------------------------------------

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
