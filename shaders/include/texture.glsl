// Looks textures up: four taps, decoded before they are mixed, so that what is not linear in a texel
// (roughness, normals) gets the filtered value. Texels are words of the detail buffer's rows.

TextureUse fetchTextureUse(uint row) {
    const uvec4 u = ROW(materialRows, row), v = ROW(materialRows, row + 1u),
                texels = ROW(materialRows, row + 2u);
    return TextureUse(uintBitsToFloat(u.xyz), u.w, uintBitsToFloat(v.xyz), uintBitsToFloat(v.w),
                      texels.x, texels.y, texels.z, texels.w);
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

/// The texel at column x of row y, both within the picture.
vec4 fetchTexel(TextureUse t, int x, int y) {
    const uint index = uint(y) * t.width + uint(x);
    const bool half_ = isHalf(t);
    const uvec4 row = ROW(detailRows, t.firstRow + (half_ ? index >> 1u : index >> 2u));
    vec4 texel = vec4(0.0);
    if ((TEXEL_KINDS & TEXEL_KIND_BYTES) != 0u) {
        const uvec2 pair = (index & 2u) != 0u ? row.zw : row.xy;
        texel = unpackUnorm4x8((index & 1u) != 0u ? pair.y : pair.x);
        if (isSrgb(t)) texel.rgb = linearOfSrgb(texel.rgb);
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

vec4 lookUp(TextureUse t, vec2 uv) {
    const uint wrapU = t.flags >> TEXELS_WRAP_U_SHIFT & TEXELS_WRAP_MASK;
    const uint wrapV = t.flags >> TEXELS_WRAP_V_SHIFT & TEXELS_WRAP_MASK;
    const ivec2 size = ivec2(int(t.width), int(t.height));
    const vec2 at = vec2(wrapped(dot(t.uRow, vec3(uv, 1.0)), wrapU),
                         wrapped(dot(t.vRow, vec3(uv, 1.0)), wrapV)) * vec2(size);
    const bool nearest = isNearest(t);
    const vec2 corner = nearest ? at : at - 0.5;
    const vec2 whole = floor(corner), part = corner - whole;
    const ivec2 texel = ivec2(whole);
    const int x0 = beyond(texel.x, size.x, wrapU), y0 = beyond(texel.y, size.y, wrapV);
    // At 1, the end of the last texel, the nearest texel is the last one whatever the mode.
    if ((TEXEL_KINDS & TEXEL_KIND_BILINEAR) == 0u)
        return fetchTexel(t, min(texel.x, size.x - 1), min(texel.y, size.y - 1));
    const int x1 = beyond(texel.x + 1, size.x, wrapU), y1 = beyond(texel.y + 1, size.y, wrapV);
    const vec4 a = fetchTexel(t, nearest ? min(texel.x, size.x - 1) : x0,
                              nearest ? min(texel.y, size.y - 1) : y0);
    const vec4 b = fetchTexel(t, x1, y0), c = fetchTexel(t, x0, y1), d = fetchTexel(t, x1, y1);
    const vec4 mixed = mix(mix(a, b, part.x), mix(c, d, part.x), part.y);
    return nearest ? a : mixed;
}
