#version 460
#extension GL_GOOGLE_include_directive : require
#include "prelude.glsl"
#include "naive.glsl"

QUERIES_AND_ANSWERS(TriangleQuery, TriangleAnswer)

TriangleAnswer answer(TriangleQuery q) {
    const Ray ray = makeRay(q.origin, q.direction);
    const TriangleHit hit = hitTriangle(q.v0, q.v1, q.v2, ray);
    return TriangleAnswer(hit.t, hit.b1, hit.b2, hitTriangleNaively(q.v0, q.v1, q.v2, ray));
}
