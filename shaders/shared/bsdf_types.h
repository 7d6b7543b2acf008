// Surfaces as the kernel reads them: emission, and the closures that scatter light.
//
// A material is a run of rows in the material buffer: its MaterialHeader, then the parameters of its
// closures (parameters.h). Primitives name a material by its first row. docs/architecture.md says how to add a closure.
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

// --- Closures ------------------------------------------------------------------------------
// A material is a short list of closures, which scatter light together: a diffuse base, an interface on
// it (a plane, or microfacets), a clear coat, sheen. These bits say which ones it has and how they are;
// with its lobes they are the low bits of MaterialHeader::closures. A scene's kernel knows which bits some
// material has and which ones all have that they concern (CLOSURES, CLOSURES_OF_ALL).

SHARED_CONST uint LOBE_MASK = 63u;
SHARED_CONST uint CLOSURE_BASE = 1u << 6;      ///< diffuse reflection
SHARED_CONST uint CLOSURE_INTERFACE = 1u << 7; ///< what reflects and transmits by a plane or by microfacets
/// Base or coat beside the interface, so that samples choose.
SHARED_CONST uint CLOSURE_LAYERS = 1u << 8;
SHARED_CONST uint CLOSURE_COAT = 1u << 9;
SHARED_CONST uint CLOSURE_SHEEN = 1u << 10;
SHARED_CONST uint INTERFACE_IS_SMOOTH = 1u << 11;    ///< a plane
SHARED_CONST uint INTERFACE_IS_CONDUCTOR = 1u << 12; ///< Fresnel's equations of a complex index
SHARED_CONST uint INTERFACE_IS_DIELECTRIC = 1u << 13; ///< Fresnel's equations of a real index
/// All is reflected; a dielectric: all is transmitted but in total reflection.
SHARED_CONST uint INTERFACE_IS_IDEAL = 1u << 14;
SHARED_CONST uint INTERFACE_REFRACTS = 1u << 15; ///< into a volume
SHARED_CONST uint INTERFACE_IS_THIN = 1u << 16;  ///< a sheet that transmits: light goes straight through
SHARED_CONST uint FACETS_ARE_BECKMANN = 1u << 17;  ///< else GGX
SHARED_CONST uint FACETS_ARE_SEPARABLE = 1u << 18; ///< masking and shadowing; else correlated by height
SHARED_CONST uint FACETS_ARE_TURNED = 1u << 19;    ///< stretched along a direction in the frame of the tangent
SHARED_CONST uint BASE_IS_NONLINEAR = 1u << 20;    ///< its colour deepens with each reflection between base and interface
SHARED_CONST uint VOLUME_ABSORBS = 1u << 21;
SHARED_CONST uint HAS_BASE_COLOR = 1u << 22; ///< the first row is what base colours multiply
/// Its closures follow from glTF's metallic-roughness model, or from Burley's; else they are stated.
SHARED_CONST uint RECIPE_PRINCIPLED = 1u << 23;
SHARED_CONST uint RECIPE_BURLEY = 1u << 24;
SHARED_CONST uint CLOSURE_MASK = (1u << 25) - 1u;

/// Bits that concern materials with an interface only, and those that concern microfacets only.
SHARED_CONST uint INTERFACE_BITS = INTERFACE_IS_SMOOTH | INTERFACE_IS_CONDUCTOR | INTERFACE_IS_DIELECTRIC | INTERFACE_IS_IDEAL;
SHARED_CONST uint FACETS_BITS = FACETS_ARE_BECKMANN | FACETS_ARE_SEPARABLE;

/// What every material has.
struct MaterialHeader {
    vec3 emission; ///< radiance, W sr^-1 m^-2
    uint closures; ///< LOBE_ and closure bits | MATERIAL_EMITS_BOTH_SIDES ... MATERIAL_RELIEF_SHADOWS
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

// --- Numbers --------------------------------------------------------------------------------

/// The transmittance of an interface of microfacets from outside, seen at the cosine mu, is a cubic
/// polynomial on each of so many equal pieces of sqrt(mu) in [0, 1]: one row each, the coefficients by
/// rising powers of the place in the piece, [0, 1].
SHARED_CONST uint TRANSMITTANCE_PIECES = 16u;

/// The least parameter of GGX, and of Beckmann's distribution. Roundings of two directions turn their half vector by up to 12 * 2^-24 (three
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

SHARED_END

#endif
