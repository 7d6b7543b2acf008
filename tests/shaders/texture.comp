#version 460
#extension GL_GOOGLE_include_directive : require
#include "prelude.glsl"

QUERIES_AND_ANSWERS(TextureQuery, TextureAnswer)

TextureAnswer answer(TextureQuery q) {
    const vec4 texel = lookUp(fetchTextureUse(q.row), vec2(q.u, q.v));
    return TextureAnswer(texel.rgb, texel.a);
}
