#version 460
#extension GL_GOOGLE_include_directive : require
#include "prelude.glsl"

QUERIES_AND_ANSWERS(TermQuery, TermAnswer)

TermAnswer answer(TermQuery q) {
    float cosTransmitted;
    const float dielectric = fresnelDielectric(q.x, q.alpha, cosTransmitted);
    return TermAnswer(fresnelConductor(q.x, q.eta, q.k), erfPositive(q.x),
                      approximateFresnelConductor(q.x, q.eta, q.k), facetArea(FacetShape(vec2(q.alpha), true, false), vec3(sqrt(max(1.0 - q.x * q.x, 0.0)), 0.0, q.x), LAMBDA_TAIL) / q.x - 1.0, dielectric,
                      cosTransmitted, schlickFresnel(q.x, q.alpha), 0.0);
}
