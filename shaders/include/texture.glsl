// Looks textures up: four texels, decoded before they are mixed, so that what is not linear in a texel
// (roughness, normals) gets the filtered value. Texels are words of the detail buffer's rows
// (shared/texture_types.h).

/// Whether some texture of the scene has coordinates that are transformed, or a scale.
bool texturesAreAdjusted() { return (TEXEL_KINDS & TEXEL_KIND_ADJUSTED) != 0u; }

TextureUse fetchTextureUse(uint row) {
    const uvec4 texels = ROW(materialRows, row);
    TextureUse t = TextureUse(texels.x, texels.y, texels.z, texels.w, vec3(1.0, 0.0, 0.0), 1.0,
                              vec3(0.0, 1.0, 0.0), 0u);
    if (texturesAreAdjusted()) {
        const vec4 u = uintBitsToFloat(ROW(materialRows, row + 1u)),
                   v = uintBitsToFloat(ROW(materialRows, row + 2u));
        t.uRow = u.xyz;
        t.vRow = v.xyz;
        t.scale = u.w;
    }
    return t;
}

/// A picture of one texel, whichever that is, for lanes that do not use what they look up.
TextureUse noTexture() {
    return TextureUse(0u, 1u, 1u, 0u, vec3(0.0), 0.0, vec3(0.0), 0u);
}

/// Texture coordinates as a texture's transform makes them. What is not finite in one makes both none, so that they
/// count as 0 (wrapped()), whether other textures of the scene have transforms or not: the products with 0 have it so.
vec2 adjusted(TextureUse t, vec2 uv) {
    if (texturesAreAdjusted()) return vec2(dot(t.uRow, vec3(uv, 1.0)), dot(t.vRow, vec3(uv, 1.0)));
    const bool isFinite = larger(abs(uv.x), abs(uv.y)) < uintBitsToFloat(0x7F800000u);
    return isFinite ? uv : vec2(0.0);
}

/// Whether a texture has a flag; known without looking where all textures of the scene are of the kind, or none are.
bool hasFlag(TextureUse t, uint flag, uint kind, uint otherKind) {
    return (TEXEL_KINDS & kind) != 0u &&
           ((TEXEL_KINDS & otherKind) == 0u || (t.flags & flag) != 0u);
}
bool isNearest(TextureUse t) {
    return hasFlag(t, TEXELS_NEAREST, TEXEL_KIND_NEAREST, TEXEL_KIND_BILINEAR);
}
bool isPlain(TextureUse t) {
    return hasFlag(t, TEXELS_PLAIN, TEXEL_KIND_PLAIN, TEXEL_KIND_GATHERED);
}
bool isHalf(TextureUse t) { return hasFlag(t, TEXELS_HALF, TEXEL_KIND_HALF, TEXEL_KIND_BYTES); }
/// WRAP_ of a direction: TEXELS_WRAP_U_SHIFT or TEXELS_WRAP_V_SHIFT.
uint wrapMode(TextureUse t, uint shift) {
    const uint kinds = TEXEL_KINDS & (TEXEL_KIND_REPEAT | TEXEL_KIND_MIRROR | TEXEL_KIND_CLAMP);
    if (kinds == TEXEL_KIND_REPEAT) return WRAP_REPEAT;
    if (kinds == TEXEL_KIND_MIRROR) return WRAP_MIRROR;
    if (kinds == TEXEL_KIND_CLAMP) return WRAP_CLAMP;
    return t.flags >> shift & TEXELS_WRAP_MASK;
}
/// Whether the texels of a plain texture are sRGB.
bool isSrgb(TextureUse t) {
    return (TEXEL_KINDS & TEXEL_KIND_SRGB) != 0u && (t.flags & TEXELS_SRGB) != 0u;
}

/// sRGB to linear (IEC 61966-2-1), within 1.1e-4 of the value and 2^-23; 0 and 1 are exact. Above the linear part
/// 1 + (c - 1) r(c), r fitted for the least relative error.
vec3 linearOfSrgb(vec3 c) {
    const vec3 r =
        ((((-0.112695153 * c + 0.278409903) * c - 0.329268961) * c + 0.471745378) * c +
         0.964194767) * c + 0.999139122;
    return mix(1.0 + (c - 1.0) * r, c * (1.0 / 12.92), lessThanEqual(c, vec3(0.04045)));
}

vec4 bytesOf(uint word, bool srgb) {
    // Signed conversions, which all processors have (docs/theory/kernel.md, "Arithmetic").
    vec4 texel = vec4(ivec4(uvec4(word, word >> 8u, word >> 16u, word >> 24u) & 0xFFu)) * (1.0 / 255.0);
    if (srgb) texel.rgb = linearOfSrgb(texel.rgb);
    return texel;
}

/// A coordinate as a place within the picture, [0, 1]. Beyond 2^24 floats have no fractions; they and what is not
/// a number count as 0, where the coordinate is not clamped.
float wrapped(float u, uint mode) {
    const float clamped = u > 0.0 ? min(u, 1.0) : 0.0;
    const bool huge = !(abs(u) < 16777216.0);
    const float turns = mode == WRAP_MIRROR ? 0.5 * u : u;
    const float part = huge ? 0.0 : turns - floor(turns);
    const float mirrored = 1.0 - abs(1.0 - 2.0 * part);
    return mode == WRAP_CLAMP ? clamped : (mode == WRAP_MIRROR ? mirrored : part);
}

/// The upper left of the four texels about a place, from -1, and how much those to the right and below count; of the
/// nearest texel that one, and 0.
struct PicturePlace {
    ivec2 texel;
    vec2 part;
};

PicturePlace placeIn(TextureUse t, vec2 uv) {
    const vec2 place = adjusted(t, uv);
    const ivec2 size = ivec2(int(t.width), int(t.height));
    const vec2 at = vec2(wrapped(place.x, wrapMode(t, TEXELS_WRAP_U_SHIFT)),
                         wrapped(place.y, wrapMode(t, TEXELS_WRAP_V_SHIFT))) * vec2(size);
    const vec2 corner = at - 0.5;
    const vec2 whole = floor(corner);
    // At 1, the end of the last texel, the nearest texel is the last one whatever the mode.
    const ivec2 nearest = min(ivec2(floor(at)), size - 1);
    return isNearest(t) ? PicturePlace(nearest, vec2(0.0)) : PicturePlace(ivec2(whole), corner - whole);
}

/// Number of a place's texel among those that a texture has rows for, those beyond the edges included.
uint gatheredRow(TextureUse t, PicturePlace p) {
    return uint(p.texel.y + 1) * (t.width + 2u) + uint(p.texel.x + 1);
}

/// The four texels of a place, in units of `unit`: upper left, upper right, lower left, lower right.
struct FourTexels {
    vec4 a, b, c, d;
    float unit;
};

// Signed conversions, which all processors have (docs/theory/kernel.md, "Arithmetic").
vec4 fractionsOf(uvec2 words) {
    return vec4(ivec4(uvec4(words.x & 0xFFFFu, words.x >> 16u, words.y & 0xFFFFu, words.y >> 16u)));
}

vec4 halvesOf(uvec2 words) { return vec4(unpackHalf2x16(words.x), unpackHalf2x16(words.y)); }

FourTexels fetchGathered(TextureUse t, PicturePlace p) {
    const uint row = t.firstRow + gatheredRow(t, p);
    const uvec4 left = ROW(detailRows, row), right = ROW(detailRows, row + 1u);
    FourTexels texels;
    if ((TEXEL_KINDS & TEXEL_KIND_BYTES) != 0u)
        texels = FourTexels(fractionsOf(left.xy), fractionsOf(right.xy), fractionsOf(left.zw),
                            fractionsOf(right.zw), 1.0 / 65535.0);
    if (isHalf(t))
        texels = FourTexels(halvesOf(left.xy), halvesOf(right.xy), halvesOf(left.zw), halvesOf(right.zw), 1.0);
    return texels;
}

/// The texel before the first or behind the last of n.
int beyond(int i, int n, uint mode) {
    const bool repeats = mode == WRAP_REPEAT;
    return i < 0 ? (repeats ? n - 1 : 0) : (i >= n ? (repeats ? 0 : n - 1) : i);
}

/// Texel number `index` of a texture whose texels lie one after the other.
vec4 fetchTexel(TextureUse t, uint index) {
    const bool half_ = isHalf(t);
    const uvec4 row = ROW(detailRows, t.firstRow + (half_ ? index >> 1u : index >> 2u));
    vec4 texel = vec4(0.0);
    if ((TEXEL_KINDS & TEXEL_KIND_BYTES) != 0u) {
        const uvec2 pair = (index & 2u) != 0u ? row.zw : row.xy;
        texel = bytesOf((index & 1u) != 0u ? pair.y : pair.x, isSrgb(t));
    }
    if (half_) texel = halvesOf((index & 1u) != 0u ? row.zw : row.xy);
    return texel;
}

FourTexels fetchPlain(TextureUse t, PicturePlace p) {
    const uint wrapU = wrapMode(t, TEXELS_WRAP_U_SHIFT), wrapV = wrapMode(t, TEXELS_WRAP_V_SHIFT);
    const uvec2 x = uvec2(beyond(p.texel.x, int(t.width), wrapU), beyond(p.texel.x + 1, int(t.width), wrapU));
    const uvec2 y =
        t.width * uvec2(beyond(p.texel.y, int(t.height), wrapV), beyond(p.texel.y + 1, int(t.height), wrapV));
    return FourTexels(fetchTexel(t, y.x + x.x), fetchTexel(t, y.x + x.y), fetchTexel(t, y.y + x.x),
                      fetchTexel(t, y.y + x.y), 1.0);
}

FourTexels fetchTexels(TextureUse t, PicturePlace p) {
    if (isPlain(t)) return fetchPlain(t, p);
    return fetchGathered(t, p);
}

/// What is the same in all is exactly that between them.
vec4 mixed(FourTexels t, vec2 part) {
    const vec4 upper = t.a + part.x * (t.b - t.a), lower = t.c + part.x * (t.d - t.c);
    return (upper + part.y * (lower - upper)) * t.unit;
}

/// Looks up a texture that is not in a bundle.
vec4 lookUp(TextureUse t, vec2 uv) {
    const PicturePlace p = placeIn(t, uv);
    const FourTexels texels = fetchTexels(t, p);
    if ((TEXEL_KINDS & TEXEL_KIND_BILINEAR) == 0u) return texels.a * texels.unit;
    return mixed(texels, p.part);
}

/// Whether a picture is read backwards there.
bool isMirroredAt(float u, uint mode) {
    const float turns = 0.5 * u;
    return mode == WRAP_MIRROR && abs(u) < 16777216.0 && turns - floor(turns) >= 0.5;
}

/// How red grows along the texture coordinates of a texture that is not in a bundle: the derivative of lookUp(), 0 of
/// the nearest texel.
vec2 slopeOf(TextureUse t, vec2 uv) {
    const PicturePlace p = placeIn(t, uv);
    const FourTexels texels = fetchTexels(t, p);
    const float a = texels.a.r, b = texels.b.r, c = texels.c.r, d = texels.d.r;
    vec2 slope = isNearest(t) ? vec2(0.0)
                              : texels.unit * vec2(float(int(t.width)), float(int(t.height))) *
                                    mix(vec2(b - a, c - a), vec2(d - c, d - b), p.part.yx);
    const vec2 place = adjusted(t, uv);
    if (isMirroredAt(place.x, wrapMode(t, TEXELS_WRAP_U_SHIFT))) slope.x = -slope.x;
    if (isMirroredAt(place.y, wrapMode(t, TEXELS_WRAP_V_SHIFT))) slope.y = -slope.y;
    return slope.x * t.uRow.xy + slope.y * t.vRow.xy;
}

// --- Bundles -------------------------------------------------------------------------------------

bool hasBundles() { return (TEXEL_KINDS & TEXEL_KIND_BUNDLE) != 0u; }
bool isBundle(TextureUse t) {
    return hasFlag(t, TEXELS_BUNDLE, TEXEL_KIND_BUNDLE, TEXEL_KIND_LOOSE);
}

/// The texels of a bundle about a place: upper left, upper right, lower left, lower right.
struct BundleTexels {
    uvec4 a, b, c, d;
    vec2 part;
};

BundleTexels fetchBundle(TextureUse t, vec2 uv) {
    const PicturePlace p = placeIn(t, uv);
    const uint upper = t.firstRow + gatheredRow(t, p), lower = upper + t.width + 2u;
    return BundleTexels(ROW(detailRows, upper), ROW(detailRows, upper + 1u), ROW(detailRows, lower),
                        ROW(detailRows, lower + 1u), p.part);
}

/// x, y, z, w: of the four texels, as BundleTexels has them.
float mixed(vec4 texels, vec2 part) {
    const vec2 lines = texels.xz + part.x * (texels.yw - texels.xz);
    return lines.x + part.y * (lines.y - lines.x);
}

/// The interpolated value of the 8-bit fractions at `shift` in words of the four texels.
float mixedFraction(uvec4 words, uint shift, vec2 part) {
    return mixed(vec4(ivec4(words >> shift & 0xFFu)), part) * (1.0 / 255.0);
}
float mixedRoot(uvec4 words, uint shift, vec2 part) {
    const vec4 roots = vec4(ivec4(words >> shift & 0xFFFu));
    return mixed(roots * roots, part) * (1.0 / (4095.0 * 4095.0));
}

/// What one of its maps says, in the channels that its slot has. slot: known when the kernel is compiled.
vec4 mapOf(BundleTexels t, uint slot) {
    const uvec4 w0 = uvec4(t.a.x, t.b.x, t.c.x, t.d.x), w1 = uvec4(t.a.y, t.b.y, t.c.y, t.d.y),
                w2 = uvec4(t.a.z, t.b.z, t.c.z, t.d.z), w3 = uvec4(t.a.w, t.b.w, t.c.w, t.d.w);
    if (slot == TEXTURE_METALLIC_ROUGHNESS)
        return vec4(1.0, mixedFraction(w0, 24u, t.part), mixedFraction(w1, 24u, t.part), 1.0);
    if (slot == TEXTURE_NORMAL)
        return vec4(mixedFraction(w3, 0u, t.part), mixedFraction(w3, 8u, t.part), mixedFraction(w3, 16u, t.part), 1.0);
    if (slot == TEXTURE_EMISSION)
        return vec4(mixedRoot(w1, 12u, t.part), mixedRoot(w2, 0u, t.part), mixedRoot(w2, 12u, t.part), 1.0);
    return vec4(mixedRoot(w0, 0u, t.part), mixedRoot(w0, 12u, t.part), mixedRoot(w1, 0u, t.part),
                mixedFraction(w2, 24u, t.part));
}
