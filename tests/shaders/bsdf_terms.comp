#version 460
#extension GL_GOOGLE_include_directive : require
#include "prelude.glsl"

QUERIES_AND_ANSWERS(TermQuery, TermAnswer)

TermAnswer answer(TermQuery q) {
    float cosTransmitted;
    const float dielectric = fresnelDielectric(q.x, q.alpha, cosTransmitted);
    return TermAnswer(fresnelConductor(q.x, q.eta, q.k), erfPositive(q.x),
                      fresnelConductorCs184(q.x, q.eta, q.k), smithLambda(q.x, q.alpha), dielectric,
                      cosTransmitted, schlickCs184(q.x, q.alpha), 0.0);
}
