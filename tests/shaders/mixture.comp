#version 460
#extension GL_GOOGLE_include_directive : require
#include "prelude.glsl"

QUERIES_AND_ANSWERS(BsdfQuery, BsdfAnswer)

/// Answers for a mixture, one of whose materials is drawn first; the answer's `lobe` has the lobes of all in its upper half.
BsdfAnswer answer(BsdfQuery q) {
    SurfacePoint s = SurfacePoint(vec3(0.0), 0.0, q.geometric, q.shading, q.wo,
                                  q.outside != 0u, q.materialRow, NO_PRIMITIVE, 0.0 NO_DETAIL);
    drawMaterial(s, uvec4(floatBitsToUint(vec3(q.u, q.v, q.w)), q.unused0));
    faceForward(s);
    const Material m = inMixture(fetchMaterial(s.material), s);
    const BsdfValue f = evaluateMixture(m, s, q.wi);
    const BsdfSample b = ofMixture(sampleBsdf(m, s, vec3(q.u, q.v, q.w)), s);
    return BsdfAnswer(f.value, f.pdf, b.direction, b.pdf, b.weight, b.lobe | lobesOf(m) << 16u);
}
