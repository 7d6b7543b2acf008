// Surfaces as the kernel reads them: emission, and the parameters of one BSDF.
//
// A material is a run of rows in the material buffer: its MaterialHeader, then the parameters of its
// kind of BSDF, in a structure of that kind's own. Primitives name a material by its first row.
// docs/architecture.md says how to add a kind.
#ifndef STROMBOLI_SHARED_BSDF_TYPES_H
#define STROMBOLI_SHARED_BSDF_TYPES_H

#include "language.h"

SHARED_BEGIN

// --- Lobes ---------------------------------------------------------------------------------
// A BSDF is a sum of lobes; each is one of these. Delta lobes scatter into single directions: no
// light sample finds one, and their densities have no value.

SHARED_CONST uint LOBE_DIFFUSE_REFLECTION = 1u;
SHARED_CONST uint LOBE_GLOSSY_REFLECTION = 2u;
SHARED_CONST uint LOBE_DELTA_REFLECTION = 4u;
SHARED_CONST uint LOBE_DIFFUSE_TRANSMISSION = 8u;
SHARED_CONST uint LOBE_GLOSSY_TRANSMISSION = 16u;
SHARED_CONST uint LOBE_DELTA_TRANSMISSION = 32u;

SHARED_CONST uint DELTA_LOBES = 4u | 32u;
SHARED_CONST uint TRANSMISSION_LOBES = 8u | 16u | 32u;
SHARED_CONST uint GLOSSY_LOBES = 2u | 16u;
SHARED_CONST uint DIFFUSE_LOBES = 1u | 8u;

// --- Kinds of BSDF and their parameters ------------------------------------------------------

SHARED_CONST uint BSDF_DIFFUSE = 0u;
SHARED_CONST uint BSDF_MIRROR = 1u;
SHARED_CONST uint BSDF_REFRACTION = 2u;
SHARED_CONST uint BSDF_GLASS = 3u;
SHARED_CONST uint BSDF_ROUGH_CONDUCTOR = 4u;
SHARED_CONST uint BSDF_PRINCIPLED = 5u;
SHARED_CONST uint BSDF_CONDUCTOR = 6u;        ///< smooth
SHARED_CONST uint BSDF_FACET_CONDUCTOR = 7u;  ///< microfacets of either distribution
SHARED_CONST uint BSDF_FACET_DIELECTRIC = 8u; ///< the same of a dielectric; BSDF_GLASS is smooth
SHARED_CONST uint BSDF_THIN_DIELECTRIC = 9u;
SHARED_CONST uint BSDF_PLASTIC = 10u; ///< a diffuse base under a smooth dielectric interface
SHARED_CONST uint BSDF_FACET_PLASTIC = 11u;
SHARED_CONST uint BSDF_BURLEY = 12u;
SHARED_CONST uint BSDF_KIND_COUNT = 13u;

/// The lobes of each kind.
SHARED_CONST uint DIFFUSE_BSDF_LOBES = LOBE_DIFFUSE_REFLECTION;
SHARED_CONST uint MIRROR_BSDF_LOBES = LOBE_DELTA_REFLECTION;
SHARED_CONST uint REFRACTION_BSDF_LOBES = LOBE_DELTA_TRANSMISSION;
SHARED_CONST uint GLASS_BSDF_LOBES = LOBE_DELTA_REFLECTION | LOBE_DELTA_TRANSMISSION;
SHARED_CONST uint ROUGH_CONDUCTOR_BSDF_LOBES = LOBE_GLOSSY_REFLECTION;
/// Samples of all its lobes count as glossy ones: each has the density of the mixture of all. Only those
/// materials transmit that have any transmission.
SHARED_CONST uint PRINCIPLED_BSDF_LOBES = LOBE_GLOSSY_REFLECTION | LOBE_GLOSSY_TRANSMISSION;
SHARED_CONST uint CONDUCTOR_BSDF_LOBES = LOBE_DELTA_REFLECTION;
SHARED_CONST uint FACET_CONDUCTOR_BSDF_LOBES = LOBE_GLOSSY_REFLECTION;
SHARED_CONST uint FACET_DIELECTRIC_BSDF_LOBES = LOBE_GLOSSY_REFLECTION | LOBE_GLOSSY_TRANSMISSION;
SHARED_CONST uint THIN_DIELECTRIC_BSDF_LOBES = LOBE_DELTA_REFLECTION | LOBE_DELTA_TRANSMISSION;
SHARED_CONST uint PLASTIC_BSDF_LOBES = LOBE_DELTA_REFLECTION | LOBE_DIFFUSE_REFLECTION;
/// Samples of its diffuse lobe count as glossy ones: they have the density of the mixture.
SHARED_CONST uint FACET_PLASTIC_BSDF_LOBES = LOBE_GLOSSY_REFLECTION;

/// As of the principled kind.
SHARED_CONST uint BURLEY_BSDF_LOBES = LOBE_GLOSSY_REFLECTION | LOBE_GLOSSY_TRANSMISSION;

/// What every material has.
struct MaterialHeader {
    vec3 emission; ///< radiance, W sr^-1 m^-2
    uint kind;     ///< BSDF_ kind; | MATERIAL_EMITS_BOTH_SIDES ... MATERIAL_RELIEF_SHADOWS
};
SHARED_ROWS(MaterialHeader, 1);
/// Else a surface emits only on the side that its geometric normal, as stored, points to.
SHARED_CONST uint MATERIAL_EMITS_BOTH_SIDES = 0x80000000u;
/// Nothing is scattered to the side that the normals, as stored, do not point to.
SHARED_CONST uint MATERIAL_IS_BLACK_BEHIND = 0x40000000u;
/// Normals that maps turn away from the viewer are tilted to the other side, or stay and are black; else they
/// are bent (relief.glsl).
SHARED_CONST uint MATERIAL_RELIEF_FLIPS = 0x20000000u;
SHARED_CONST uint MATERIAL_RELIEF_BLACKENS = 0x10000000u;
/// Bumps dim light that comes at grazing angles.
SHARED_CONST uint MATERIAL_RELIEF_SHADOWS = 0x08000000u;
SHARED_CONST uint MATERIAL_RELIEF_RULES =
    MATERIAL_RELIEF_FLIPS | MATERIAL_RELIEF_BLACKENS | MATERIAL_RELIEF_SHADOWS;
SHARED_CONST uint MATERIAL_KIND_MASK = 0xFFu;

struct DiffuseParameters {
    vec3 albedo;
    uint unused;
};
SHARED_ROWS(DiffuseParameters, 1);

struct MirrorParameters {
    vec3 reflectance;
    uint unused;
};
SHARED_ROWS(MirrorParameters, 1);

/// A smooth interface that only transmits; there is no Fresnel reflection.
struct RefractionParameters {
    vec3 transmittance;
    float ior; ///< index inside over index outside
};
SHARED_ROWS(RefractionParameters, 1);

/// A smooth dielectric interface.
struct GlassParameters {
    vec3 reflectance; ///< multiplies what Fresnel's equations reflect
    float ior;        ///< index inside over index outside
    vec3 transmittance;
    uint unused;
};
SHARED_ROWS(GlassParameters, 2);

/// A conductor with a Beckmann distribution of microfacets.
struct RoughConductorParameters {
    vec3 eta;    ///< real part of the index of refraction, per colour channel
    float alpha; ///< Beckmann roughness: RMS slope times sqrt(2)
    vec3 k;      ///< extinction coefficient
    uint unused;
};
SHARED_ROWS(RoughConductorParameters, 2);

// Of the kinds below, the first row is the colour that base colour textures multiply, the second one of
// plastic what textures of the specular colour do, and their last numbers are what textures of roughness
// multiply, as those of the principled material are.

/// A conductor of complex index eta + i k against what is outside of it, smooth or of microfacets.
struct ConductorParameters {
    vec3 reflectance; ///< multiplies what Fresnel's equations reflect
    float alphaY;     ///< of the microfacets, across the tangent
    vec3 eta;
    float alphaX; ///< along the tangent
    vec3 k;
    uint facets; ///< FACETS_ bits: its distribution and its masking
};
SHARED_ROWS(ConductorParameters, 3);

/// An interface of microfacets between dielectrics.
struct FacetDielectricParameters {
    vec3 transmittance; ///< multiplies what Fresnel's equations let through
    float alphaY;
    vec3 reflectance;
    float alphaX;
    float ior;        ///< index inside over index outside
    float leastAlpha; ///< either alpha is no less
    uint facets;
    uint unused;
};
SHARED_ROWS(FacetDielectricParameters, 3);

/// A sheet of a dielectric, too thin to be seen as two interfaces.
struct ThinDielectricParameters {
    vec3 transmittance;
    float ior; ///< index of the sheet over the index around it
    vec3 reflectance;
    uint unused;
};
SHARED_ROWS(ThinDielectricParameters, 2);

/// A diffuse base under the interface of a dielectric.
struct PlasticParameters {
    vec3 albedo;           ///< of the base
    float internalDiffuse; ///< share of diffuse light that the interface sends back to the base
    vec3 reflectance;      ///< multiplies what Fresnel's equations reflect
    float ior;             ///< index under the interface over the index above it
    float alpha;           ///< of the interface's microfacets
    uint flags;            ///< PLASTIC_, and FACETS_ bits
    uint table;            ///< microfacets: row of the first piece of their transmittance
    uint unused;
};
SHARED_ROWS(PlasticParameters, 3);
/// The base's colour deepens with each reflection between base and interface.
SHARED_CONST uint PLASTIC_IS_NONLINEAR = 256u;

/// The transmittance of an interface of microfacets from outside, seen at the cosine mu, is a cubic
/// polynomial on each of so many equal pieces of sqrt(mu) in [0, 1]: one row each, the coefficients by
/// rising powers of the place in the piece, [0, 1].
SHARED_CONST uint TRANSMITTANCE_PIECES = 16u;

/// The microfacets of these kinds: one of two distributions, one of two ways of masking. Those that a scene has
/// are a constant of its kernel (SPEC_FACETS).
SHARED_CONST uint FACETS_GGX = 1u;
SHARED_CONST uint FACETS_BECKMANN = 2u;
SHARED_CONST uint FACETS_CORRELATED = 4u;
SHARED_CONST uint FACETS_SEPARABLE = 8u;
/// What the materials of Burley's kind have in a scene, in the same constant.
SHARED_CONST uint BURLEY_HAS_TRANSMISSION = 16u;
SHARED_CONST uint BURLEY_HAS_THIN = 32u;

/// Burley's principled BSDF (scene/model/material.hpp). Its numbers are where textures of the principled kind's slots
/// multiply them.
struct BurleyParameters {
    vec3 baseColor;
    float metallic;
    float flatness;
    float diffuseTransmission;
    float leastAlpha;
    float roughness;
    float specularTint;
    float ior; ///< index inside over index outside
    float transmission;
    float anisotropy;
    vec3 sheen; ///< three times the same number
    float sheenTint;
    float clearcoat;
    float clearcoatGloss;
    float unused; ///< textures of anisotropy turn it
    uint flags;   ///< BURLEY_
};
SHARED_ROWS(BurleyParameters, 5);
SHARED_CONST uint BURLEY_IS_THIN = 1u;

/// glTF 2.0's metallic-roughness model and its extensions (scene/model/material.hpp).
struct PrincipledParameters {
    vec3 baseColor;
    float metallic;
    vec3 specularColor;
    float roughness; ///< glTF's: the GGX parameter is its square
    float specular;
    float ior; ///< index inside over index outside
    float transmission;
    float anisotropy; ///< strength
    vec3 sheenColor;
    float sheenRoughness;
    float clearcoat;
    float clearcoatRoughness;
    float anisotropyRotation; ///< radians from the tangent towards the bitangent
    uint flags;               ///< PRINCIPLED_
    vec3 absorption; ///< per metre, inside the surface
    float leastAlpha; ///< the GGX parameter is no less
};
SHARED_ROWS(PrincipledParameters, 6);
SHARED_CONST uint PRINCIPLED_IS_THIN = 1u; ///< there is no volume behind the surface
SHARED_CONST uint PRINCIPLED_ABSORPTION_ROW = 6u; ///< of a material, its header counted

/// The least parameter of GGX, and of the Beckmann distribution of the kinds above. Roundings of two directions turn their half vector by up to 12 * 2^-24 (three
/// in each component of either, and as many in the sum); of a lobe this wide that is 0.7 %, which is 1.5 %
/// of D at its flank. A mirror of this roughness blurs by 1e-4 radians, half a pixel of a picture 4000
/// pixels and 50 degrees wide.
SHARED_CONST float LEAST_GGX_ALPHA = 1e-4f;
/// Refraction turns by |1 - 1 / index| of what its facet does, and the half vector has that much more
/// error: it is known as well as reflection's where alpha * |1 - 1 / index| is no less than this (that is
/// 0.92e-4 for glass of index 1.5, below the other bound), a third of the least alpha.
SHARED_CONST float LEAST_REFRACTION_ALPHA = 3.0517578125e-5f;
/// An index is at least this far from 1 where light is refracted: an interface between equal indices has
/// no half vector.
SHARED_CONST float LEAST_INDEX_STEP = 9.765625e-4f;
/// Reflectance of a clear coat (index 1.5) at normal incidence.
SHARED_CONST float CLEARCOAT_F0 = 0.04f;
/// The sheen's parameter from which on its directional albedo is nowhere above 1 (at most 0.99, for mu
/// above LEAST_SHEEN_COSINE); below that, more light would be reflected than arrives.
SHARED_CONST float LEAST_SHEEN_ALPHA = 0.07f;
SHARED_CONST float LEAST_SHEEN_COSINE = 1e-3f;

/// What the principled materials of a scene have (SPEC_PRINCIPLED_FEATURES).
SHARED_CONST uint PRINCIPLED_HAS_CLEARCOAT = 1u;
SHARED_CONST uint PRINCIPLED_HAS_SHEEN = 2u;
SHARED_CONST uint PRINCIPLED_HAS_ANISOTROPY = 4u;
SHARED_CONST uint PRINCIPLED_HAS_THIN_TRANSMISSION = 8u;
SHARED_CONST uint PRINCIPLED_HAS_REFRACTION = 16u; ///< into volumes
SHARED_CONST uint PRINCIPLED_HAS_ABSORPTION = 32u; ///< in these volumes
SHARED_CONST uint PRINCIPLED_ALL_FEATURES = 63u;

SHARED_END

#endif
