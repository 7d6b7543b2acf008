#version 460
#extension GL_GOOGLE_include_directive : require
#include "prelude.glsl"

QUERIES_AND_ANSWERS(TextureQuery, TextureAnswer)

TextureAnswer answer(TextureQuery q) {
    const TextureUse t = fetchTextureUse(q.row);
    vec4 texel = vec4(0.0);
    if (q.mapPlusOne == 0u) texel = lookUp(t, vec2(q.u, q.v));
    if (q.mapPlusOne == SLOPE_OF_TEXTURE) texel.xy = slopeOf(t, vec2(q.u, q.v));
    if (q.mapPlusOne >= TANGENT_OF_CORNER) {
        const uvec4 row = tangentRow(q.row);
        texel = vec4(cornerTangent(row, q.mapPlusOne - TANGENT_OF_CORNER), bitangentSide(row));
    }
    if (hasBundles() && isBundle(t)) {
        const BundleTexels texels = fetchBundle(t, vec2(q.u, q.v));
        if (q.mapPlusOne == 1u) texel = mapOf(texels, TEXTURE_BASE_COLOR);
        if (q.mapPlusOne == 2u) texel = mapOf(texels, TEXTURE_METALLIC_ROUGHNESS);
        if (q.mapPlusOne == 3u) texel = mapOf(texels, TEXTURE_NORMAL);
        if (q.mapPlusOne == 4u) texel = mapOf(texels, TEXTURE_EMISSION);
    }
    return TextureAnswer(texel.rgb, texel.a);
}
