#version 460
#extension GL_GOOGLE_include_directive : require
#include "prelude.glsl"
#include "include/gap_proposal.glsl"

QUERIES_AND_ANSWERS(GapQuery, GapAnswer)

GapAnswer answer(GapQuery q) {
    const Gap gap = findGap(frame, findOnlyLight());
    const GapView g = viewGap(gap, q.position);
    const vec2 at = sampleRims(gap, g, vec2(q.u, q.v));
    const vec3 alongPlane = (at.x - g.foot.x) * gap.along0 + (at.y - g.foot.y) * gap.along1;
    const vec3 w = unit(alongPlane - g.height * gap.normal);
    const vec2 middle = 0.5 * gap.size - g.foot;
    const vec3 toLight = unit(middle.x * gap.along0 + middle.y * gap.along1 -
                             g.height * gap.normal);
    return GapAnswer(w, gapPdf(gap, g, w), at.x, at.y, gapPdf(gap, g, -w), gapPdf(gap, g, toLight));
}
