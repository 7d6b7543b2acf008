// Surfaces as the kernel reads them: emission, and the parameters of what scatters light.
//
// A material is a run of rows in the material buffer: its MaterialHeader, then the parameters of its
// closures (parameters.h). Primitives name a material by its first row.
#ifndef STROMBOLI_SHARED_BSDF_TYPES_H
#define STROMBOLI_SHARED_BSDF_TYPES_H

#include "language.h"
#include "parameters.h"

SHARED_BEGIN

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
