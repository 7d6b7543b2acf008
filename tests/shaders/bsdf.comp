#version 460
#extension GL_GOOGLE_include_directive : require
#include "prelude.glsl"

QUERIES_AND_ANSWERS(BsdfQuery, BsdfAnswer)

BsdfAnswer answer(BsdfQuery q) {
    SurfacePoint s = SurfacePoint(vec3(0.0), 0.0, q.geometric, q.shading, q.wo,
                                  q.outside != 0u, q.material, NO_PRIMITIVE, 0.0);
    faceForward(s);
    const Material m = fetchMaterial(q.material);
    const BsdfSample b = sampleBsdf(m, s, vec2(q.u, q.v));
    const bool rough = m.kind == MATERIAL_MICROFACET;
    return BsdfAnswer(evaluateBsdf(m, s, q.wi), b.transmitted ? 1u : 0u, b.direction,
                      rough ? microfacetPdf(m, s, q.wi) : 0.0, b.weight, 0u);
}
