#version 460
#extension GL_GOOGLE_include_directive : require
#include "prelude.glsl"
#include "include/lamp_gap.glsl"

QUERIES_AND_ANSWERS(GapQuery, GapAnswer)

GapAnswer answer(GapQuery q) {
    findLampGap();
    const GapView g = viewGap(q.position);
    const vec2 at = sampleRims(g, vec2(q.u, q.v));
    const vec3 alongPlane = (at.x - g.foot.x) * lampGap.along0 + (at.y - g.foot.y) * lampGap.along1;
    const vec3 w = unit(alongPlane - g.height * lampGap.normal);
    const vec2 middle = 0.5 * lampGap.size - g.foot;
    const vec3 toLamp = unit(middle.x * lampGap.along0 + middle.y * lampGap.along1 -
                             g.height * lampGap.normal);
    return GapAnswer(w, gapPdf(g, w), at.x, at.y, gapPdf(g, -w), gapPdf(g, toLamp));
}
