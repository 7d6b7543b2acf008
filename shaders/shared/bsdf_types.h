// Surfaces as the kernel reads them: emission, and the closures that scatter light.
//
// A material is a run of rows in the material buffer: its MaterialHeader, then the parameters of its
// closures (parameters.h). Primitives name a material by its first row. docs/architecture.md says how to add a closure.
#ifndef STROMBOLI_SHARED_BSDF_TYPES_H
#define STROMBOLI_SHARED_BSDF_TYPES_H

#include "language.h"

SHARED_BEGIN

// --- Lobes and closures ----------------------------------------------------------------------
// A BSDF is a sum of lobes; each is one of the LOBE_ bits. Delta lobes scatter into single directions: no light sample
// finds one, and their densities have no value.
//
// A material is a short list of closures, which scatter light together: a diffuse base, an interface on it (a plane, or
// microfacets), a clear coat, sheen. The other bits say which ones it has and how they are; all are the low bits of
// MaterialHeader::closures. A scene's kernel knows which bits some material has and which ones all have that they concern
// (CLOSURES, CLOSURES_OF_ALL).

// F(name, bit, label): label: what `stromboli info` calls it. Of them:
//   CLOSURE_LAYERS           base or coat beside the interface, so that samples choose
//   INTERFACE_IS_IDEAL       all is reflected; a dielectric: all is transmitted but in total reflection
//   INTERFACE_REFRACTS       into a volume
//   INTERFACE_IS_THIN        a sheet that transmits: light goes straight through
//   FACETS_ARE_BECKMANN      else GGX
//   FACETS_ARE_SEPARABLE     masking and shadowing; else correlated by height
//   FACETS_ARE_TURNED        stretched along a direction in the frame of the tangent
//   BASE_IS_NONLINEAR        its colour deepens with each reflection between base and interface
//   HAS_BASE_COLOR           the first row is what base colours multiply
//   PHASE_FUNCTION           it is no surface but a medium (medium_types.h)
//   RECIPE_                  its closures follow from glTF's metallic-roughness model, or from Burley's; else they are
//                            stated (parameters.h)
#define CLOSURE_LIST(F) \
    F(LOBE_DIFFUSE_REFLECTION, 0, "diffuse reflection") \
    F(LOBE_GLOSSY_REFLECTION, 1, "glossy reflection") \
    F(LOBE_DELTA_REFLECTION, 2, "mirror reflection") \
    F(LOBE_DIFFUSE_TRANSMISSION, 3, "diffuse transmission") \
    F(LOBE_GLOSSY_TRANSMISSION, 4, "glossy transmission") \
    F(LOBE_DELTA_TRANSMISSION, 5, "clear transmission") \
    F(CLOSURE_BASE, 6, "diffuse base") \
    F(CLOSURE_INTERFACE, 7, "interface") \
    F(CLOSURE_LAYERS, 8, "base under an interface") \
    F(CLOSURE_COAT, 9, "clear coat") \
    F(CLOSURE_SHEEN, 10, "sheen") \
    F(INTERFACE_IS_SMOOTH, 11, "smooth interface") \
    F(INTERFACE_IS_CONDUCTOR, 12, "conductor") \
    F(INTERFACE_IS_DIELECTRIC, 13, "dielectric") \
    F(INTERFACE_IS_IDEAL, 14, "ideal interface") \
    F(INTERFACE_REFRACTS, 15, "refraction") \
    F(INTERFACE_IS_THIN, 16, "thin sheet") \
    F(FACETS_ARE_BECKMANN, 17, "Beckmann's microfacets") \
    F(FACETS_ARE_SEPARABLE, 18, "separable masking") \
    F(FACETS_ARE_TURNED, 19, "turned grain") \
    F(BASE_IS_NONLINEAR, 20, "base that deepens") \
    F(VOLUME_ABSORBS, 21, "absorption") \
    F(HAS_BASE_COLOR, 22, "base color") \
    F(RECIPE_PRINCIPLED, 23, "glTF's recipe") \
    F(RECIPE_BURLEY, 24, "Burley's recipe") \
    F(PHASE_FUNCTION, 25, "phase function") \
    F(PHASE_IS_RAYLEIGH, 26, "Rayleigh's phase function")

#define NAME_CLOSURE(name, bit, label) SHARED_CONST uint name = 1u << bit;
CLOSURE_LIST(NAME_CLOSURE)
#undef NAME_CLOSURE
#define ADD_CLOSURE(name, bit, label) | name
SHARED_CONST uint CLOSURE_MASK = 0u CLOSURE_LIST(ADD_CLOSURE);
#undef ADD_CLOSURE

SHARED_CONST uint DELTA_LOBES = LOBE_DELTA_REFLECTION | LOBE_DELTA_TRANSMISSION;
SHARED_CONST uint GLOSSY_LOBES = LOBE_GLOSSY_REFLECTION | LOBE_GLOSSY_TRANSMISSION;
SHARED_CONST uint DIFFUSE_LOBES = LOBE_DIFFUSE_REFLECTION | LOBE_DIFFUSE_TRANSMISSION;
SHARED_CONST uint TRANSMISSION_LOBES =
    LOBE_DIFFUSE_TRANSMISSION | LOBE_GLOSSY_TRANSMISSION | LOBE_DELTA_TRANSMISSION;
SHARED_CONST uint LOBE_MASK =
    LOBE_DIFFUSE_REFLECTION | LOBE_GLOSSY_REFLECTION | LOBE_DELTA_REFLECTION | TRANSMISSION_LOBES;

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
