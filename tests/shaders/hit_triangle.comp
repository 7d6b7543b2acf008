#version 460
#extension GL_GOOGLE_include_directive : require
#include "prelude.glsl"
#include "naive.glsl"

QUERIES_AND_ANSWERS(TriangleQuery, TriangleAnswer)

TriangleAnswer answer(TriangleQuery q) {
    const Ray ray = makeRay(q.origin, q.direction);
    const TrianglePairHit alone = hitTrianglePair(LeafPoints(q.v0, q.v1, q.v2, q.v2), ray);
    const TrianglePairHit second = hitTrianglePair(LeafPoints(q.v0, q.v0, q.v1, q.v2), ray);
    return TriangleAnswer(alone.first.t, alone.first.b1, alone.first.b2,
                          hitTriangleNaively(q.v0, q.v1, q.v2, ray), second.second.t,
                          second.second.b1, second.second.b2,
                          min(alone.second.t, second.first.t));
}
