#version 460
#extension GL_GOOGLE_include_directive : require
// Rays through the hierarchy, and, with segmentBase primitives, against every one of them.
#include "prelude.glsl"
#include "naive.glsl"

QUERIES_AND_ANSWERS(RayQuery, RayAnswer)

RayAnswer answer(RayQuery q) {
    RayAnswer a = RayAnswer(0.0, 0.0, 0.0, NO_PRIMITIVE, 0u, 0u, 0u, q.tMax);
    Traversal t;
    startTraversal(t, q.origin, q.direction, q.tMin, q.tMax, q.skipPrimitive, q.anyHit != 0u);
    while (traversing(t) && a.steps < dispatch.hardIterations) {
        traversalStep(t);
        ++a.steps;
    }
    a.t = t.tMax;
    a.b1 = t.b1;
    a.b2 = t.b2;
    a.primitive = t.hitPrimitive;
    for (uint i = 0u; i < dispatch.segmentBase; ++i) {
        const Primitive p = fetchPrimitive(i);
        const float hit = p.kind == PRIMITIVE_SPHERE
                              ? hitSphere(p.v0, p.v1.x, t.ray, q.tMin, q.tMax)
                              : hitTriangle(p.v0, p.v1, p.v2, t.ray).t;
        const float naive = hitTriangleNaively(p.v0, p.v1, p.v2, t.ray);
        const bool counts = hit > q.tMin && hit < q.tMax && i != q.skipPrimitive;
        if (counts) a.bruteT = min(a.bruteT, hit);
        a.bruteHits += counts ? 1u : 0u;
        a.naiveHits += naive > q.tMin && naive < q.tMax ? 1u : 0u;
    }
    return a;
}
