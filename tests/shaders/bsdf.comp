#version 460
#extension GL_GOOGLE_include_directive : require
#include "prelude.glsl"

QUERIES_AND_ANSWERS(BsdfQuery, BsdfAnswer)

BsdfAnswer answer(BsdfQuery q) {
    SurfacePoint s = SurfacePoint(vec3(0.0), 0.0, q.geometric, q.shading, q.wo,
                                  q.outside != 0u, q.materialRow, NO_PRIMITIVE, 0.0 NO_DETAIL);
    faceForward(s);
    const Material m = fetchMaterial(q.materialRow);
    const BsdfValue f = evaluateBsdf(m, s, q.wi);
    const BsdfSample b = sampleBsdf(m, s, vec3(q.u, q.v, q.w));
    return BsdfAnswer(f.value, f.pdf, b.direction, b.pdf, b.weight, b.lobe);
}
