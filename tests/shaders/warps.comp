#version 460
#extension GL_GOOGLE_include_directive : require
#include "prelude.glsl"

QUERIES_AND_ANSWERS(WarpQuery, WarpAnswer)

WarpAnswer answer(WarpQuery q) {
    const vec2 u = vec2(q.u, q.v), disk = sampleDisk(u);
    const ShadingFrame f = makeFrame(q.normal);
    const vec2 turned = cosSin(4.0 * q.u);
    return WarpAnswer(sampleCosineHemisphere(u), disk.x, sampleUniformHemisphere(u), disk.y,
                      sampleFacet(FacetShape(vec2(q.alpha), true, false), vec3(0.0, 0.0, 1.0), u), turned.x, f.x, turned.y, f.y, 0u, f.z, 0u,
                      decodeNormal(q.encodedNormal), 0u);
}
