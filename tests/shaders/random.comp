#version 460
#extension GL_GOOGLE_include_directive : require
#include "prelude.glsl"

QUERIES_AND_ANSWERS(RandomQuery, RandomAnswer)

RandomAnswer answer(RandomQuery q) {
    const uvec4 words = uvec4(q.x, q.y, q.z, q.w), h = pcg4d(words);
    const vec4 u = unitFloats(words), b = randomBlock(q.x, q.y, q.z, q.w);
    return RandomAnswer(uint[4](h.x, h.y, h.z, h.w), float[4](u.x, u.y, u.z, u.w),
                        float[4](b.x, b.y, b.z, b.w),
                        leftOver(randomWords(q.x, q.y, q.z, q.w)), uint[3](0u, 0u, 0u));
}
