// What a material is at a point of a surface: its parameters times textures and the colours of corners, its
// opacity, and what a normal map says. docs/theory/surfaces.md, "Textures", has the rules.

#include "include/texture.glsl"

/// Whether some material of the scene has a texture in this slot.
bool sceneHasSlot(uint slot) { return (TEXTURE_SLOTS & 1u << slot) != 0u; }
/// Whether materials have a MaterialDetail.
bool hasDetails() { return TEXTURE_SLOTS != 0u || HAS_ALPHA || HAS_BLENDS; }
bool hasAttribute(uint which) { return (ATTRIBUTES & which) != 0u; }
bool hasNormalMaps() { return sceneHasSlot(TEXTURE_NORMAL) && hasAttribute(ATTRIBUTE_TANGENT); }
bool hasHeights() { return sceneHasSlot(TEXTURE_HEIGHT) && hasAttribute(ATTRIBUTE_UV0); }

// --- Attributes of corners -----------------------------------------------------------------------

/// Rows of one primitive's attributes, up to but without the attribute `end`.
uint attributeRows(uint end) {
    return (hasAttribute(ATTRIBUTE_UV0) && end > ATTRIBUTE_UV0 ? UV_ROWS : 0u) +
           (hasAttribute(ATTRIBUTE_UV1) && end > ATTRIBUTE_UV1 ? UV_ROWS : 0u) +
           (hasAttribute(ATTRIBUTE_COLOR) && end > ATTRIBUTE_COLOR ? COLOR_ROWS : 0u) +
           (hasAttribute(ATTRIBUTE_TANGENT) && end > ATTRIBUTE_TANGENT ? TANGENT_ROWS : 0u);
}

/// What a point has of its primitive's corners. Spheres have neither texture coordinates nor colours: they are
/// (0, 0) and white.
struct PointAttributes {
    vec2 uv0, uv1;
    vec4 color;
};

// Attributes are interpolated by their differences, so that what is the same at all corners is exactly that everywhere:
// a mask whose opacity is its cutoff depends on it.

vec2 interpolatedUv(uint row, vec2 b) {
    const vec4 first = uintBitsToFloat(ROW(detailRows, row));
    const vec2 last = uintBitsToFloat(ROW(detailRows, row + 1u).xy);
    return first.xy + b.x * (first.zw - first.xy) + b.y * (last - first.xy);
}

vec4 interpolatedColor(uint row, vec2 b) {
    const vec4 c0 = uintBitsToFloat(ROW(detailRows, row)),
               c1 = uintBitsToFloat(ROW(detailRows, row + 1u)),
               c2 = uintBitsToFloat(ROW(detailRows, row + 2u));
    return c0 + b.x * (c1 - c0) + b.y * (c2 - c0);
}

/// The primitive at a place of the tree, in the Primitive buffer.
uint primitiveAt(uint place) {
    return (ROW(recordRows, RECORD_ROWS * (place >> 1u)).w & RECORD_INDEX_MASK) + (place & 1u);
}

/// Where a primitive's attributes begin in the detail buffer.
uint attributeRow(uint primitive, uint which) {
    return primitive * attributeRows(~0u) + attributeRows(which);
}

uvec4 tangentRow(uint primitive) { return ROW(detailRows, attributeRow(primitive, ATTRIBUTE_TANGENT)); }

/// The tangent of corner 0, 1 or 2, times 8191.
vec3 cornerTangent(uvec4 tangents, uint corner) {
    const uint word = corner == 0u ? tangents.x : (corner == 1u ? tangents.y : tangents.z);
    const int x = int(word << 18u) >> 18, y = int(word << 4u) >> 18;
    const int upperZ = int(tangents.w << (22u - 10u * corner)) >> 22;
    return vec3(ivec3(x, y, upperZ << 4 | int(word >> 28u)));
}

/// 1 or -1: the bitangent is normal x tangent times that; 0: there is no tangent.
float bitangentSide(uvec4 tangents) { return float(int(tangents.w) >> 30); }

/// b: barycentric weights of the second and third corner.
PointAttributes attributesAt(uint primitive, vec2 b) {
    PointAttributes a = PointAttributes(vec2(0.0), vec2(0.0), vec4(1.0));
    if (hasAttribute(ATTRIBUTE_UV0))
        a.uv0 = interpolatedUv(attributeRow(primitive, ATTRIBUTE_UV0), b);
    if (hasAttribute(ATTRIBUTE_UV1))
        a.uv1 = interpolatedUv(attributeRow(primitive, ATTRIBUTE_UV1), b);
    if (hasAttribute(ATTRIBUTE_COLOR))
        a.color = interpolatedColor(attributeRow(primitive, ATTRIBUTE_COLOR), b);
    return a;
}

vec2 coordinatesOf(TextureUse t, PointAttributes a) {
    const bool second = hasAttribute(ATTRIBUTE_UV1) && (t.flags & TEXTURE_SECOND_UV) != 0u;
    return second ? a.uv1 : a.uv0;
}

// --- Textures of a material -----------------------------------------------------------------------

/// row: the material's first.
MaterialDetail fetchDetail(uint row) {
    const uvec4 r = ROW(materialRows, row + MATERIAL_DETAIL_ROW);
    return MaterialDetail(uintBitsToFloat(r.x), uintBitsToFloat(r.y), r.z, r.w);
}

/// The first row of a material's texture.
uint textureUseRow(uint materialRow, uint number) {
    return materialRow + MATERIAL_DETAIL_ROW + 1u + TEXTURE_USE_ROWS * number;
}

/// How many bundles each material has, 0 or 1.
uint bundles() { return hasBundles() ? 1u : 0u; }

uint looseTexturesOf(MaterialDetail detail) { return detail.looseTextures & DETAIL_LOOSE_MASK; }

/// The texture with this number plus one; 0, where a material has none: a picture of one texel, to no effect.
TextureUse fetchTextureUse(uint materialRow, uint numberPlusOne) {
    if (numberPlusOne == 0u) return noTexture();
    return fetchTextureUse(textureUseRow(materialRow, numberPlusOne - 1u));
}

// --- What a material is at a point ------------------------------------------------------------------

/// A point of a primitive.
struct MaterialPoint {
    uint material;  ///< its first row
    uint primitive; ///< NO_PRIMITIVE: a sphere, which has no attributes
    vec2 weights;   ///< barycentric, of the second and third corner
};

/// What maps say of the normal at a point.
struct Relief {
    vec3 mapped; ///< a normal map's vector in the frame of the surface's tangent; (0, 0, 1) without one
    vec2 slope;  ///< of heights, along the texture coordinates
    bool mirrorsBehind; ///< from behind both are seen in a mirror; with RELIEF_RULES
};

/// s: not yet faced forward.
void mirrorBehind(inout Relief relief, SurfacePoint s) {
    if (relief.mirrorsBehind && isSeenFromBehind(s)) {
        relief.mapped.xy = -relief.mapped.xy;
        relief.slope = -relief.slope;
    }
}

/// What a material is at a point.
struct MaterialAtPoint {
    Material parameters;
    Relief relief;
    vec3 emissionFactor; ///< by which textures have multiplied the emission
    float opacity;       ///< the share of light that meets the surface; 1 where the material has no alpha mode
};

vec3 mappedNormal(vec4 texel, float scale_) {
    return vec3((2.0 * texel.xy - 1.0) * scale_, 2.0 * texel.z - 1.0);
}

/// Whether loose textures have this slot, and whether this one does.
bool isLoose(uint slot, uint wanted) {
    return (LOOSE_SLOTS & 1u << wanted) != 0u && slot == wanted;
}

/// The direction of glTF's anisotropy, as the texel turns it.
void turnGrain(inout Material m, vec4 texel) {
    const vec2 along = 2.0 * texel.xy - 1.0;
    PrincipledParameters p = principledParameters(m);
    p.anisotropyRotation += along == vec2(0.0) ? 0.0 : atan(along.y, along.x);
    setParameters(m, p);
}

/// Multiplies the parameters behind the first row by the texel of a loose texture, as its slot says.
void applyToParameters(inout Material m, uint slot, vec4 texel) {
#define APPLY(slot_, recipe, name, factor)                                                         \
    if (isLoose(slot, TEXTURE_##slot_) && isOf##recipe(m)) multiply##recipe##_##name(m, factor);
    TEXTURED_PARAMETERS(APPLY)
#undef APPLY
    if (isLoose(slot, TEXTURE_ANISOTROPY) && isOfPrincipled(m)) turnGrain(m, texel);
}

/// Multiplies them likewise by the texel of a bundle's metallic-roughness map.
void applyBundledRoughness(inout Material m, vec4 texel) {
#define APPLY(slot_, recipe, name, factor)                                                         \
    if (TEXTURE_##slot_ == TEXTURE_METALLIC_ROUGHNESS && isOf##recipe(m)) multiply##recipe##_##name(m, factor);
    TEXTURED_PARAMETERS(APPLY)
#undef APPLY
}

/// Whether a texture is no part of these: what takes the material's place, the coat's normal.
bool isReadElsewhere(uint slot) {
    return sceneHasSlot(TEXTURE_BLEND_SHARE) && slot == TEXTURE_BLEND_SHARE ||
           sceneHasSlot(TEXTURE_CLEARCOAT_NORMAL) && slot == TEXTURE_CLEARCOAT_NORMAL;
}

/// A texel's part in the parameters (shared/parameters.h, TEXTURED_PARAMETERS), and in what maps say.
void applyTexel(inout MaterialAtPoint at, TextureUse t, vec4 texel) {
    const uint slot = t.flags & TEXTURE_SLOT_MASK;
    if (isLoose(slot, TEXTURE_BASE_COLOR)) {
        multiplyBaseColor(at.parameters, texel.rgb);
        at.opacity *= texel.a;
    }
    if (isLoose(slot, TEXTURE_OPACITY)) at.opacity *= t.scale < 0.0 ? 1.0 - texel.r : texel.r;
    if (isLoose(slot, TEXTURE_EMISSION)) {
        multiply(at.parameters.header.xyz, texel.rgb);
        at.emissionFactor *= texel.rgb;
    }
    if (isLoose(slot, TEXTURE_NORMAL)) at.relief.mapped = mappedNormal(texel, t.scale);
    if (materialsHaveRow(2u)) applyToParameters(at.parameters, slot, texel);
}

/// The bundle's part in them.
void applyBundle(inout MaterialAtPoint at, uint materialRow, PointAttributes a) {
    const TextureUse t = fetchTextureUse(textureUseRow(materialRow, 0u));
    const BundleTexels texels = fetchBundle(t, coordinatesOf(t, a));
    if (sceneHasSlot(TEXTURE_BASE_COLOR)) {
        const vec4 texel = mapOf(texels, TEXTURE_BASE_COLOR);
        multiplyBaseColor(at.parameters, texel.rgb);
        at.opacity *= texel.a;
    }
    if (sceneHasSlot(TEXTURE_EMISSION)) {
        const vec3 texel = mapOf(texels, TEXTURE_EMISSION).rgb;
        multiply(at.parameters.header.xyz, texel);
        at.emissionFactor *= texel;
    }
    if (sceneHasSlot(TEXTURE_NORMAL) && (t.flags & TEXELS_MAP_NORMALS) != 0u)
        at.relief.mapped = mappedNormal(mapOf(texels, TEXTURE_NORMAL), t.scale);
    if (sceneHasSlot(TEXTURE_METALLIC_ROUGHNESS) && materialsHaveRow(2u))
        applyBundledRoughness(at.parameters, mapOf(texels, TEXTURE_METALLIC_ROUGHNESS));
}

PointAttributes attributesOf(MaterialPoint p) {
    PointAttributes a = PointAttributes(vec2(0.0), vec2(0.0), vec4(1.0));
    if (ATTRIBUTES != 0u && p.primitive != NO_PRIMITIVE) a = attributesAt(p.primitive, p.weights);
    return a;
}

/// The point of a surface. Spheres have no place in the tree that is to be skipped.
MaterialPoint materialPoint(SurfacePoint s) {
    const bool isTriangle = s.skipPrimitive != NO_PRIMITIVE;
    return MaterialPoint(s.material, isTriangle ? s.primitive : NO_PRIMITIVE, s.weights);
}
PointAttributes attributesOf(SurfacePoint s) { return attributesOf(materialPoint(s)); }

/// The point at a hit. place: of the primitive in the tree; b: barycentric weights.
MaterialPoint materialPoint(uint place, vec2 b) {
    const PlacedPrimitive p = fetchPlace(place);
    return MaterialPoint(materialOf(fetchPrimitive(p.primitive)), p.isSphere ? NO_PRIMITIVE : p.primitive, b);
}

/// product: of all that multiplies opacity.
float countedOpacity(MaterialDetail detail, float product) {
    if (!HAS_ALPHA) return 1.0;
    if ((detail.flags & DETAIL_MASK) != 0u) return product >= detail.alphaCutoff ? 1.0 : 0.0;
    return (detail.flags & DETAIL_BLEND) != 0u ? clamp(product, 0.0, 1.0) : 1.0;
}

/// The loose texture with this number, its part in them.
void applyLooseTexture(inout MaterialAtPoint at, uint materialRow, uint number, PointAttributes a) {
    const TextureUse t = fetchTextureUse(textureUseRow(materialRow, bundles() + number));
    if (isReadElsewhere(t.flags & TEXTURE_SLOT_MASK)) return;
    applyTexel(at, t, lookUp(t, coordinatesOf(t, a)));
    if (hasHeights() && (t.flags & TEXTURE_SLOT_MASK) == TEXTURE_HEIGHT)
        at.relief.slope = t.scale * slopeOf(t, coordinatesOf(t, a));
}

/// One after the other. Without a loop where no material of the scene has two; else with the exit at its end, as
/// llvmpipe runs a body once more, for no lane, after an exit in the header (docs/theory/kernel.md, "Exits of loops").
void applyLooseTextures(inout MaterialAtPoint at, uint materialRow, uint count, PointAttributes a) {
    uint i = 0u;
    do {
        if (i < count) applyLooseTexture(at, materialRow, i, a);
        ++i;
    } while (LOOSE_TEXTURES > 1u && i < count);
}

MaterialAtPoint lookUpMaterial(MaterialPoint p) {
    MaterialAtPoint at =
        MaterialAtPoint(fetchMaterial(p.material), Relief(vec3(0.0, 0.0, 1.0), vec2(0.0), false), vec3(1.0), 1.0);
    const PointAttributes a = attributesOf(p);
    if (hasAttribute(ATTRIBUTE_COLOR)) multiplyBaseColor(at.parameters, a.color.rgb);
    if (!hasDetails()) return at;
    const MaterialDetail detail = fetchDetail(p.material);
    at.opacity = detail.opacity * a.color.a;
    if (RELIEF_RULES) at.relief.mirrorsBehind = (detail.flags & DETAIL_MIRRORS_RELIEF) != 0u;
    if (hasBundles()) applyBundle(at, p.material, a);
    if (LOOSE_SLOTS != 0u) applyLooseTextures(at, p.material, looseTexturesOf(detail), a);
    at.opacity = countedOpacity(detail, at.opacity);
    return at;
}

/// By what the emission of an emissive primitive is multiplied at a point of it, for light samples: by its texture, and
/// by the share of it that is there.
vec3 emissionFactorOf(MaterialAtPoint at) { return at.emissionFactor * at.opacity; }
/// Whether that is not 1 everywhere in the scene.
bool emissionHasFactors() { return sceneHasSlot(TEXTURE_EMISSION) || HAS_ALPHA; }

/// For rays that come straight from the camera: they pass what is hidden from it.
float opacityForCamera(MaterialPoint p, float opacity) {
    return HIDES_SURFACES && (fetchDetail(p.material).flags & DETAIL_IS_HIDDEN) != 0u ? 0.0 : opacity;
}
