// Looks textures up: four taps, decoded before they are mixed, so that what is not linear in a texel
// (roughness, normals) gets the filtered value. Texels are words of the detail buffer's rows.

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

/// Of any texture of the scene: known without looking where all or none are of the kind.
bool hasFlag(TextureUse t, uint flag, uint kind, uint otherKind) {
    return (TEXEL_KINDS & kind) != 0u &&
           ((TEXEL_KINDS & otherKind) == 0u || (t.flags & flag) != 0u);
}
bool isNearest(TextureUse t) {
    return hasFlag(t, TEXELS_NEAREST, TEXEL_KIND_NEAREST, TEXEL_KIND_BILINEAR);
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
    // Signed conversions, which all processors have (docs/kernel.md, "Arithmetic").
    vec4 texel = vec4(ivec4(uvec4(word, word >> 8u, word >> 16u, word >> 24u) & 0xFFu)) * (1.0 / 255.0);
    if (srgb) texel.rgb = linearOfSrgb(texel.rgb);
    return texel;
}

/// Texel number `index` of a texture, in the order of rows.
vec4 fetchTexel(TextureUse t, uint index) {
    const bool half_ = isHalf(t);
    const uvec4 row = ROW(detailRows, t.firstRow + (half_ ? index >> 1u : index >> 2u));
    vec4 texel = vec4(0.0);
    if ((TEXEL_KINDS & TEXEL_KIND_BYTES) != 0u) {
        const uvec2 pair = (index & 2u) != 0u ? row.zw : row.xy;
        texel = bytesOf((index & 1u) != 0u ? pair.y : pair.x, isSrgb(t));
    }
    if (half_) {
        const uvec2 pair = (index & 1u) != 0u ? row.zw : row.xy;
        texel = vec4(unpackHalf2x16(pair.x), unpackHalf2x16(pair.y));
    }
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

/// The texel before the first or behind the last of n.
int beyond(int i, int n, uint mode) {
    const bool repeats = mode == WRAP_REPEAT;
    return i < 0 ? (repeats ? n - 1 : 0) : (i >= n ? (repeats ? 0 : n - 1) : i);
}

/// The four texels about a place, upper ones first, and how much the right and the lower ones count; for the
/// nearest texel all four are that one.
struct Taps {
    uvec4 texels; ///< numbers, in the order of rows
    vec2 part;
};

Taps tapsAt(TextureUse t, vec2 uv) {
    const uint wrapU = wrapMode(t, TEXELS_WRAP_U_SHIFT), wrapV = wrapMode(t, TEXELS_WRAP_V_SHIFT);
    const vec2 place = adjusted(t, uv);
    const ivec2 size = ivec2(int(t.width), int(t.height));
    const vec2 at = vec2(wrapped(place.x, wrapU), wrapped(place.y, wrapV)) * vec2(size);
    // At 1, the end of the last texel, the nearest texel is the last one whatever the mode.
    const ivec2 nearest = min(ivec2(floor(at)), size - 1);
    const uint nearestTexel = uint(nearest.y) * t.width + uint(nearest.x);
    const vec2 corner = at - 0.5;
    const vec2 whole = floor(corner);
    const ivec2 texel = ivec2(whole);
    const uvec2 x = uvec2(beyond(texel.x, size.x, wrapU), beyond(texel.x + 1, size.x, wrapU));
    const uvec2 y =
        t.width * uvec2(beyond(texel.y, size.y, wrapV), beyond(texel.y + 1, size.y, wrapV));
    const Taps taps = Taps(uvec4(y.x + x, y.y + x), corner - whole);
    return isNearest(t) ? Taps(uvec4(nearestTexel), vec2(0.0)) : taps;
}

/// What is the same in all is exactly that between them.
vec4 mixed(vec4 a, vec4 b, vec4 c, vec4 d, vec2 part) {
    const vec4 upper = a + part.x * (b - a), lower = c + part.x * (d - c);
    return upper + part.y * (lower - upper);
}

/// Of a texture that is not in a bundle.
vec4 lookUp(TextureUse t, vec2 uv) {
    const Taps taps = tapsAt(t, uv);
    const vec4 a = fetchTexel(t, taps.texels.x);
    if ((TEXEL_KINDS & TEXEL_KIND_BILINEAR) == 0u) return a;
    const vec4 b = fetchTexel(t, taps.texels.y), c = fetchTexel(t, taps.texels.z),
               d = fetchTexel(t, taps.texels.w);
    return isNearest(t) ? a : mixed(a, b, c, d, taps.part);
}

/// Whether a picture is read backwards there.
bool isMirroredAt(float u, uint mode) {
    const float turns = 0.5 * u;
    return mode == WRAP_MIRROR && abs(u) < 16777216.0 && turns - floor(turns) >= 0.5;
}

/// How red grows along the texture coordinates of a texture that is not in a bundle: the derivative of lookUp(), 0 of
/// the nearest texel.
vec2 slopeOf(TextureUse t, vec2 uv) {
    const Taps taps = tapsAt(t, uv);
    const float a = fetchTexel(t, taps.texels.x).r, b = fetchTexel(t, taps.texels.y).r,
                c = fetchTexel(t, taps.texels.z).r, d = fetchTexel(t, taps.texels.w).r;
    vec2 slope = vec2(float(int(t.width)), float(int(t.height))) *
                 mix(vec2(b - a, c - a), vec2(d - c, d - b), taps.part.yx);
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

/// The four rows about a place of a bundle.
struct BundleTaps {
    uvec4 a, b, c, d;
    vec2 part;
};

BundleTaps fetchBundle(TextureUse t, vec2 uv) {
    const Taps taps = tapsAt(t, uv);
    return BundleTaps(ROW(detailRows, t.firstRow + taps.texels.x),
                      ROW(detailRows, t.firstRow + taps.texels.y),
                      ROW(detailRows, t.firstRow + taps.texels.z),
                      ROW(detailRows, t.firstRow + taps.texels.w), taps.part);
}

/// What one of its maps says. slot: known when the kernel is compiled.
vec4 mapOf(BundleTaps t, uint slot) {
    const bool srgb = slot == TEXTURE_BASE_COLOR || slot == TEXTURE_EMISSION;
    return mixed(bytesOf(t.a[slot], srgb), bytesOf(t.b[slot], srgb), bytesOf(t.c[slot], srgb),
                 bytesOf(t.d[slot], srgb), t.part);
}
