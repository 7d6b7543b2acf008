// What materials are made of: the closures that scatter light, which of them a material has, a table of parameters for each
// recipe by which closures follow from a material, and which textures multiply them. From these tables C++ and GLSL have the
// bits, the structures, the code that reads and packs them and their places in the rows behind a material's header;
// `tests/shaders/layout_test.cpp` reads every one back. docs/theory/extending.md says how to add a closure.
#ifndef STROMBOLI_SHARED_PARAMETERS_H
#define STROMBOLI_SHARED_PARAMETERS_H

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

// F(kind, when, bits): a material `m` of that MaterialKind has these bits where `when` is true; all C++
// (host/kernel/material_rows.cpp). isSmooth: its interface is a plane. plane: bits of that, or of its microfacets; reflects,
// passes: the lobes of either. Samples of a mixture of closures count as glossy ones: they have the density of all.
#define CLOSURES_OF_KINDS(F) \
    F(Diffuse, true, CLOSURE_BASE | LOBE_DIFFUSE_REFLECTION) \
    F(Mirror, true, CLOSURE_INTERFACE | INTERFACE_IS_SMOOTH | INTERFACE_IS_IDEAL | LOBE_DELTA_REFLECTION) \
    F(Refraction, true, CLOSURE_INTERFACE | INTERFACE_IS_SMOOTH | INTERFACE_IS_IDEAL | INTERFACE_IS_DIELECTRIC) \
    F(Refraction, true, INTERFACE_REFRACTS | LOBE_DELTA_TRANSMISSION) \
    F(Conductor, true, CLOSURE_INTERFACE | INTERFACE_IS_CONDUCTOR | plane | reflects) \
    F(Dielectric, true, CLOSURE_INTERFACE | INTERFACE_IS_DIELECTRIC | INTERFACE_REFRACTS | plane | reflects | passes) \
    F(ThinDielectric, true, CLOSURE_INTERFACE | INTERFACE_IS_SMOOTH | INTERFACE_IS_DIELECTRIC | INTERFACE_IS_THIN) \
    F(ThinDielectric, true, LOBE_DELTA_REFLECTION | LOBE_DELTA_TRANSMISSION) \
    F(Plastic, true, CLOSURE_BASE | CLOSURE_INTERFACE | CLOSURE_LAYERS | INTERFACE_IS_DIELECTRIC | plane | reflects) \
    F(Plastic, isSmooth, LOBE_DIFFUSE_REFLECTION) \
    F(Plastic, m.isNonlinear, BASE_IS_NONLINEAR) \
    F(Principled, true, RECIPE_PRINCIPLED | CLOSURE_INTERFACE | reflects) \
    F(Principled, isSmooth, INTERFACE_IS_SMOOTH) \
    F(Principled, !isSmooth, CLOSURE_BASE) \
    F(Principled, m.principled.clearcoat > 0, CLOSURE_COAT) \
    F(Principled, m.principled.sheenColor != glm::vec3(0), CLOSURE_SHEEN) \
    F(Principled, m.principled.anisotropy > 0, FACETS_ARE_TURNED) \
    F(Principled, transmits(m), passes) \
    F(Principled, transmits(m) && m.principled.isThin, INTERFACE_IS_THIN) \
    F(Principled, passesDiffusely(m), LOBE_DIFFUSE_TRANSMISSION | LOBE_GLOSSY_TRANSMISSION) \
    F(Principled, refracts(m), INTERFACE_REFRACTS | INTERFACE_IS_DIELECTRIC) \
    F(Principled, absorbs(m), VOLUME_ABSORBS) \
    F(Burley, true, RECIPE_BURLEY | CLOSURE_BASE | CLOSURE_INTERFACE | INTERFACE_IS_DIELECTRIC) \
    F(Burley, true, FACETS_ARE_SEPARABLE | LOBE_GLOSSY_REFLECTION) \
    F(Burley, m.burley.clearcoat > 0 && !m.burley.isThin, CLOSURE_COAT) \
    F(Burley, m.burley.sheen > 0, CLOSURE_SHEEN) \
    F(Burley, m.burley.isThin, INTERFACE_IS_THIN) \
    F(Burley, passesThrough(m) && !m.burley.isThin, INTERFACE_REFRACTS) \
    F(Burley, passesThrough(m), LOBE_GLOSSY_TRANSMISSION)

// --- Parameters ------------------------------------------------------------------------------

// F(type, name, row, place, value): in the order of their places, of which none is left out.
//   row, place  where it is: a row of the material, whose header is row 0, and components of it
//   value       C++: how it follows from `m`, a Material of the scene (host/kernel/material_rows.cpp)

/// Stated closures: a base, an interface, or a base under an interface. A base alone and a mirror read the first row
/// only. The values are those that `stated` has found for the material's kind.
/// color: albedo of the base; transmittance of a dielectric; reflectance of a conductor or a mirror. alphaY: of the
/// microfacets, across the tangent, as alphaX is along it; a smooth dielectric has its index here too, for scenes without
/// third rows. edge: what multiplies the reflection of a dielectric; real part of a conductor's index. index: INDEX_
/// components of a dielectric; extinction coefficient of a conductor. table: base under microfacets: row of the first
/// piece of their transmittance.
#define STATED_PARAMETERS(F) \
    F(vec3, color, 1, xyz, stated.color) \
    F(float, alphaY, 1, w, stated.alphaY) \
    F(vec3, edge, 2, xyz, stated.edge) \
    F(float, alphaX, 2, w, stated.alphaX) \
    F(vec3, index, 3, xyz, stated.index) \
    F(uint, table, 3, w, 0)

/// glTF 2.0's metallic-roughness model and its extensions (scene/model/material.hpp).
/// roughness, clearcoatRoughness: glTF's, whose squares are the parameters of GGX. ior: index inside over outside.
/// anisotropy: its strength. anisotropyRotation: radians from the tangent towards the bitangent. absorption: per metre,
/// inside the surface. leastAlpha: the parameter of GGX is no less. spread: half the difference between the indices of
/// blue and red light; below 0 where there is no volume behind the surface. diffuseTransmission: share of what is
/// diffuse, with a colour of its own. film: in nanometres; the span is what textures multiply.
#define PRINCIPLED_PARAMETERS(F) \
    F(vec3, baseColor, 1, xyz, m.principled.baseColor) \
    F(float, metallic, 1, w, m.principled.metallic) \
    F(vec3, specularColor, 2, xyz, m.principled.specularColor) \
    F(float, roughness, 2, w, m.principled.roughness) \
    F(float, specular, 3, x, m.principled.specular) \
    F(float, ior, 3, y, usedIndex(m)) \
    F(float, transmission, 3, z, m.principled.transmission) \
    F(float, anisotropy, 3, w, m.principled.anisotropy) \
    F(vec3, sheenColor, 4, xyz, m.principled.sheenColor) \
    F(float, sheenRoughness, 4, w, m.principled.sheenRoughness) \
    F(float, clearcoat, 5, x, m.principled.clearcoat) \
    F(float, clearcoatRoughness, 5, y, m.principled.clearcoatRoughness) \
    F(float, anisotropyRotation, 5, z, m.principled.anisotropyRotation) \
    F(float, spread, 5, w, indexSpreadOf(m)) \
    F(vec3, absorption, 6, xyz, m.principled.absorption()) \
    F(float, leastAlpha, 6, w, leastAlphaOf(m)) \
    F(vec3, diffuseTransmissionColor, 7, xyz, m.principled.diffuseTransmissionColor) \
    F(float, diffuseTransmission, 7, w, m.principled.diffuseTransmission) \
    F(float, iridescence, 8, x, m.principled.iridescence) \
    F(float, filmIor, 8, y, m.principled.filmIor) \
    F(float, filmThickness, 8, z, m.principled.filmThickness) \
    F(float, filmSpan, 8, w, m.principled.filmSpan)

/// Burley's principled BSDF (scene/model/material.hpp). ior: index inside over outside. leastAlpha: neither parameter of
/// the facets is less.
#define BURLEY_PARAMETERS(F) \
    F(vec3, baseColor, 1, xyz, m.burley.baseColor) \
    F(float, metallic, 1, w, m.burley.isThin ? 0 : m.burley.metallic) \
    F(float, flatness, 2, x, m.burley.flatness) \
    F(float, diffuseTransmission, 2, y, m.burley.diffuseTransmission) \
    F(float, leastAlpha, 2, z, m.burley.leastAlpha()) \
    F(float, roughness, 2, w, m.burley.roughness) \
    F(float, specularTint, 3, x, m.burley.specularTint) \
    F(float, ior, 3, y, m.burley.usedIor()) \
    F(float, transmission, 3, z, m.burley.transmission) \
    F(float, anisotropy, 3, w, m.burley.anisotropy) \
    F(float, sheen, 4, x, m.burley.sheen) \
    F(float, sheenTint, 4, y, m.burley.sheenTint) \
    F(float, clearcoat, 4, z, m.burley.isThin ? 0 : m.burley.clearcoat) \
    F(float, clearcoatGloss, 4, w, m.burley.clearcoatGloss)

#define DECLARE_PARAMETER(type, name, row, place, value) type name;
struct StatedParameters {
    STATED_PARAMETERS(DECLARE_PARAMETER)
};
struct PrincipledParameters {
    PRINCIPLED_PARAMETERS(DECLARE_PARAMETER)
};
struct BurleyParameters {
    BURLEY_PARAMETERS(DECLARE_PARAMETER)
};
#undef DECLARE_PARAMETER
SHARED_ROWS(StatedParameters, 3);
SHARED_ROWS(PrincipledParameters, 8);
SHARED_ROWS(BurleyParameters, 4);

SHARED_CONST int INDEX_RATIO = 0;       ///< index inside over index outside
SHARED_CONST int INDEX_BACK = 1;        ///< share of diffuse light that the interface sends back to the base
SHARED_CONST int INDEX_LEAST_ALPHA = 2; ///< either alpha of the microfacets is no less
SHARED_CONST uint STATED_TABLE_ROW = 3u; ///< of a material, its header counted: its last word is `table`
SHARED_CONST uint PRINCIPLED_ABSORPTION_ROW = 6u; ///< of a material, its header counted

/// The last row that some recipe has.
SHARED_CONST uint MOST_PARAMETER_ROWS = 8u;

/// A scene's materials have the row where its closures have one of these bits; row 1 they always have. Row 7
/// is there for LOBE_DIFFUSE_TRANSMISSION, row 8 for HAS_IRIDESCENCE.
SHARED_FUNCTION uint closuresWithRow(uint row) {
    const uint indices =
        INTERFACE_IS_CONDUCTOR | CLOSURE_LAYERS | GLOSSY_LOBES | RECIPE_PRINCIPLED | RECIPE_BURLEY;
    if (row == 2u) return indices | INTERFACE_IS_DIELECTRIC;
    if (row == 3u) return indices;
    if (row == 4u) return RECIPE_PRINCIPLED | RECIPE_BURLEY;
    return row <= 1u ? CLOSURE_MASK : RECIPE_PRINCIPLED;
}

/// F(slot, recipe, name, factor): a texture in the slot TEXTURE_slot multiplies that parameter by what its texel has for
/// it. Base colours are in all recipes' first place, and multiplied there. The reference has its own list
/// (host/reference/surface_textures.cpp).
#define TEXTURED_PARAMETERS(F) \
    F(METALLIC_ROUGHNESS, Stated, alphaX, texel.g) \
    F(METALLIC_ROUGHNESS, Stated, alphaY, texel.b) \
    F(SPECULAR_COLOR, Stated, edge, texel.rgb) \
    F(METALLIC_ROUGHNESS, Principled, roughness, texel.g) \
    F(METALLIC_ROUGHNESS, Principled, metallic, texel.b) \
    F(TRANSMISSION, Principled, transmission, texel.r) \
    F(SPECULAR, Principled, specular, texel.a) \
    F(SPECULAR_COLOR, Principled, specularColor, texel.rgb) \
    F(CLEARCOAT, Principled, clearcoat, texel.r) \
    F(CLEARCOAT_ROUGHNESS, Principled, clearcoatRoughness, texel.g) \
    F(SHEEN_COLOR, Principled, sheenColor, texel.rgb) \
    F(SHEEN_ROUGHNESS, Principled, sheenRoughness, texel.a) \
    F(ANISOTROPY, Principled, anisotropy, texel.b) \
    F(DIFFUSE_TRANSMISSION, Principled, diffuseTransmission, texel.a) \
    F(DIFFUSE_TRANSMISSION_COLOR, Principled, diffuseTransmissionColor, texel.rgb) \
    F(IRIDESCENCE, Principled, iridescence, texel.r) \
    F(FILM_THICKNESS, Principled, filmSpan, texel.g) \
    F(METALLIC_ROUGHNESS, Burley, roughness, texel.g) \
    F(METALLIC_ROUGHNESS, Burley, metallic, texel.b) \
    F(TRANSMISSION, Burley, transmission, texel.r) \
    F(SPECULAR, Burley, specularTint, texel.a) \
    F(SPECULAR_COLOR, Burley, flatness, texel.r) \
    F(SPECULAR_COLOR, Burley, diffuseTransmission, texel.g) \
    F(CLEARCOAT, Burley, clearcoat, texel.r) \
    F(CLEARCOAT_ROUGHNESS, Burley, clearcoatGloss, texel.g) \
    F(SHEEN_COLOR, Burley, sheen, texel.r) \
    F(SHEEN_ROUGHNESS, Burley, sheenTint, texel.a) \
    F(ANISOTROPY, Burley, anisotropy, texel.b)

SHARED_END

#endif
