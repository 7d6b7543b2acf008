// What materials and primitives have beside parameters and normals: textures, opacity, attributes of
// corners. Scenes that have none of them have none of these rows.
#ifndef STROMBOLI_SHARED_TEXTURE_TYPES_H
#define STROMBOLI_SHARED_TEXTURE_TYPES_H

#include "language.h"

SHARED_BEGIN

// --- In the material buffer ------------------------------------------------------------------

/// Where a scene has textures or opacity, every material has this row, so many rows after its header,
/// whatever its kind; behind it follow its bundle, where some material of the scene has one, and its loose
/// textures, the slots in ascending order. A material without maps in a bundle has one of a single texel without
/// pictures then, so that no lane has to ask.
SHARED_CONST uint MATERIAL_DETAIL_ROW = 9u;
struct MaterialDetail {
    float opacity;
    float alphaCutoff;
    uint flags; ///< DETAIL_
    /// How many TextureUse follow beside the bundle's, in bits 0 to 7; in bits 8 to 15 the number of the one
    /// with TEXTURE_CLEARCOAT_NORMAL, plus one; 0: there is none.
    uint looseTextures;
};
SHARED_ROWS(MaterialDetail, 1);
SHARED_CONST uint DETAIL_MASK = 1u;  ///< there where opacity is at least alphaCutoff, else not
SHARED_CONST uint DETAIL_BLEND = 2u; ///< opacity is the share of light that meets the surface
SHARED_CONST uint DETAIL_IS_HIDDEN = 32u; ///< camera rays pass it
/// The clear coat has a normal of its own: the surface's before TEXTURE_NORMAL turned it, or what
/// TEXTURE_CLEARCOAT_NORMAL makes of that.
SHARED_CONST uint DETAIL_COAT_HAS_NORMAL = 64u;
SHARED_CONST uint DETAIL_LOOSE_MASK = 0xFFu;
SHARED_CONST uint DETAIL_COAT_NORMAL_SHIFT = 8u; ///< in looseTextures
/// From behind, heights and maps of normals are seen in a mirror.
SHARED_CONST uint DETAIL_MIRRORS_RELIEF = 128u;
/// It is a mixture: the row behind its textures is a BlendRow.
SHARED_CONST uint DETAIL_IS_BLEND = 16u;

/// What takes a material's place, and how often.
struct BlendRow {
    uint other;   ///< the first row of that material
    float share;  ///< of cases
    uint texture; ///< the number of the TextureUse that multiplies it, plus one; 0: none
    uint place;   ///< OTHER_; | BLEND_
};
SHARED_ROWS(BlendRow, 1);
/// A mixture whose materials are evaluated together says how many there are beside any one of them (0: one is drawn),
/// and the lobes of all.
SHARED_CONST uint BLEND_OTHERS_SHIFT = 8u;
SHARED_CONST uint BLEND_OTHERS_MASK = 0xFFu;
SHARED_CONST uint BLEND_LOBES_SHIFT = 16u;
/// OtherPlace of scene/model/material.hpp: in all cases, or on one side of the surface.
SHARED_CONST uint OTHER_MASK = 3u;
SHARED_CONST uint OTHER_BY_SHARE = 0u;
SHARED_CONST uint OTHER_BEHIND = 1u;
SHARED_CONST uint OTHER_IN_FRONT = 2u;
/// A mixture is of so many materials and one more, at most.
SHARED_CONST uint MOST_BLENDS = 255u;

/// A texture of a material, or a bundle of them: which slot it has, where it is looked up, and where its texels are.
struct TextureUse {
    uint firstRow; ///< of its texels in the detail buffer
    uint width;
    uint height;
    uint flags; ///< TEXTURE_ slot, of no meaning for bundles; | TEXTURE_SECOND_UV | TEXELS_
    // Read only where this changes some texture of the scene (TEXEL_KIND_ADJUSTED).
    vec3 uRow; ///< u' = uRow . (u, v, 1)
    float scale; ///< TEXTURE_NORMAL, _CLEARCOAT_NORMAL: of the tangential part; _HEIGHT: of all; _OPACITY: below 0, its negative
    vec3 vRow; ///< v' = vRow . (u, v, 1)
    uint unused;
};
SHARED_ROWS(TextureUse, 3);
SHARED_OFFSET(TextureUse, uRow, 16);
SHARED_OFFSET(TextureUse, vRow, 32);
SHARED_CONST uint TEXTURE_USE_ROWS = 3u;
SHARED_CONST uint TEXTURE_SLOT_MASK = 0xFFu;
SHARED_CONST uint TEXTURE_SECOND_UV = 0x100u; ///< the second set of texture coordinates

// F(name, slot, number, label): what a texture of a material changes.
//   name    TEXTURE_name is its number
//   slot    the TextureSlot of scene/model/texture.hpp, which says what its channels are
//   number  host/kernel/detail_plan.cpp compares it with that of the TextureSlot
//   label   what `stromboli kernels` calls it
#define TEXTURE_SLOT_LIST(F) \
    F(BASE_COLOR, BaseColor, 0, "base color") \
    F(METALLIC_ROUGHNESS, MetallicRoughness, 1, "metallic-roughness") \
    F(NORMAL, Normal, 2, "normal") \
    F(EMISSION, Emission, 3, "emission") \
    F(TRANSMISSION, Transmission, 4, "transmission") \
    F(SPECULAR, Specular, 5, "specular") \
    F(SPECULAR_COLOR, SpecularColor, 6, "specular color") \
    F(CLEARCOAT, Clearcoat, 7, "clearcoat") \
    F(CLEARCOAT_ROUGHNESS, ClearcoatRoughness, 8, "clearcoat roughness") \
    F(CLEARCOAT_NORMAL, ClearcoatNormal, 9, "clearcoat normal") \
    F(SHEEN_COLOR, SheenColor, 10, "sheen color") \
    F(SHEEN_ROUGHNESS, SheenRoughness, 11, "sheen roughness") \
    F(ANISOTROPY, Anisotropy, 12, "anisotropy") \
    F(HEIGHT, Height, 13, "height") \
    F(BLEND_SHARE, BlendShare, 14, "share of a mixture") \
    F(PROJECTION, Projection, 15, "of a projector") \
    F(OPACITY, Opacity, 16, "opacity") \
    F(DIFFUSE_TRANSMISSION, DiffuseTransmission, 17, "diffuse transmission") \
    F(DIFFUSE_TRANSMISSION_COLOR, DiffuseTransmissionColor, 18, "diffuse transmission color") \
    F(IRIDESCENCE, Iridescence, 19, "iridescence") \
    F(FILM_THICKNESS, FilmThickness, 20, "film thickness")

#define NUMBER_SLOT(name, slot, number, label) SHARED_CONST uint TEXTURE_##name = uint(number);
TEXTURE_SLOT_LIST(NUMBER_SLOT)
#undef NUMBER_SLOT
#define COUNT_SLOT(name, slot, number, label) +1u
SHARED_CONST uint TEXTURE_SLOT_COUNT = 0u TEXTURE_SLOT_LIST(COUNT_SLOT);
#undef COUNT_SLOT

/// How a texture's coordinates become a texel, and what a texel is.
///
/// Where there is room for it (host/kernel/detail_plan) a row holds texels that are looked up together, those beyond the
/// edges included, so that a lookup loads two rows that follow each other and minds no edge: of a picture of w x h
/// texels row (y + 1) (w + 2) + x + 1 has the texels (x, y) and (x, y + 1), x from -1 to w, y from -1 to h - 1. A texel
/// is two words: four half floats, or four fractions of 65,535, linear, so that nothing is left to decode. Half floats
/// that fractions hold as exactly become fractions (host/kernel/detail_plan.cpp, areFractions()).
///
/// Else (TEXELS_PLAIN) they lie one after the other, the first word of all in word 0 of firstRow: two words of half
/// floats, or one of four fractions of 255, sRGB where TEXELS_SRGB is set.
SHARED_CONST uint TEXELS_WRAP_U_SHIFT = 16u; ///< two bits, WRAP_
SHARED_CONST uint TEXELS_WRAP_V_SHIFT = 18u;
SHARED_CONST uint TEXELS_WRAP_MASK = 3u;
SHARED_CONST uint WRAP_REPEAT = 0u;
SHARED_CONST uint WRAP_MIRROR = 1u;
SHARED_CONST uint WRAP_CLAMP = 2u;
SHARED_CONST uint TEXELS_NEAREST = 0x100000u; ///< the nearest texel; else bilinear
SHARED_CONST uint TEXELS_SRGB = 0x200000u; ///< red, green and blue are sRGB; of plain texels
SHARED_CONST uint TEXELS_HALF = 0x400000u; ///< half floats
SHARED_CONST uint TEXELS_PLAIN = 0x2000000u;
/// A bundle: pictures of one size that a material looks up alike, so that one row holds a texel of all: row
/// (y + 1) (w + 2) + x + 1 is the texel (x, y), x from -1 to w, y from -1 to h. From the lowest bit, words 0 to 2 have
/// two roots and a fraction each: base color red, green, and roughness; base color blue, emission red, and the metallic
/// factor; emission green, blue, and the base color's alpha. Word 3 has the normal's three fractions. A root (12 bits)
/// is the square root of a linear value, times 4095 and rounded: its square is within 0.05 of the distance between two
/// sRGB bytes' values. A fraction (8 bits) is of 255. What has no picture has all bits set.
SHARED_CONST uint TEXELS_BUNDLE = 0x800000u;
SHARED_CONST uint TEXELS_MAP_NORMALS = 0x1000000u; ///< of a bundle: it has a map of TEXTURE_NORMAL
/// Slots that bundles may have: those from 0.
SHARED_CONST uint BUNDLE_MAPS = 4u;

// --- In the detail buffer ----------------------------------------------------------------------
// First the attributes of all primitives' corners, in the order of the Primitive buffer, then texels.

/// Which attributes a scene's primitives have (SPEC_ATTRIBUTES). Of each primitive those that there are follow each
/// other in this order: texture coordinates of the three corners, one set in two rows (u and v of the first two
/// corners, then of the third), colours in three, tangents in one: their components are numbers of 14 bits with a sign,
/// of 8191. Word n has x and y of corner n, and the lower four bits of z; word 3 the upper ten bits of the three z, and
/// in its last two bits 1 for the bitangent normal x tangent, 3 for its opposite, 0 for no tangent.
SHARED_CONST uint ATTRIBUTE_UV0 = 1u;
SHARED_CONST uint ATTRIBUTE_UV1 = 2u;
SHARED_CONST uint ATTRIBUTE_COLOR = 4u;
SHARED_CONST uint ATTRIBUTE_TANGENT = 8u;
SHARED_CONST uint UV_ROWS = 2u;
SHARED_CONST uint COLOR_ROWS = 3u;
SHARED_CONST uint TANGENT_ROWS = 1u;

SHARED_END

#endif
