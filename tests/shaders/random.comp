#version 460
#extension GL_GOOGLE_include_directive : require
#include "prelude.glsl"

QUERIES_AND_ANSWERS(RandomQuery, RandomAnswer)

RandomAnswer answer(RandomQuery q) {
    const uvec4 words = uvec4(q.x, q.y, q.z, q.w), h = pcg4d(words);
    const vec4 u = unitFloats(words), b = randomBlock(q.x, q.y, q.z, q.w);
    const uvec2 divided = quotientAndRest(q.x, max(q.y, 1u));
    return RandomAnswer(uint[4](h.x, h.y, h.z, h.w), float[4](u.x, u.y, u.z, u.w),
                        float[4](b.x, b.y, b.z, b.w),
                        leftOver(randomWords(q.x, q.y, q.z, q.w)), divided.x, divided.y, 0u);
}
