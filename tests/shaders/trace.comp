#version 460
#extension GL_GOOGLE_include_directive : require
// Rays through the hierarchy, and against every primitive of its first segmentBase records.
#include "prelude.glsl"
#include "naive.glsl"

QUERIES_AND_ANSWERS(RayQuery, RayAnswer)

void traverse(inout Traversal t, inout Stack stack, Ray ray, inout RayAnswer a) {
    while (traversing(t) && a.steps < dispatch.hardIterations) {
        a.highestEntry = max(a.highestEntry, entriesInUse(stack));
        traversalStep(t, stack, ray);
        ++a.steps;
    }
    a.t = t.tMax;
    a.b1 = t.b1;
    a.b2 = t.b2;
    a.primitive = t.hitPrimitive;
}

void tryOne(RayQuery q, Ray ray, uint place, float t, vec3 v0, vec3 v1, vec3 v2,
            inout RayAnswer a) {
    const float naive = hitTriangleNaively(v0, v1, v2, ray);
    const bool counts = t > q.tMin && t < q.tMax && place != q.skipPrimitive;
    if (counts) a.bruteT = min(a.bruteT, t);
    a.bruteHits += counts ? 1u : 0u;
    a.naiveHits += naive > q.tMin && naive < q.tMax ? 1u : 0u;
}

void tryRecord(RayQuery q, Ray ray, uint record, inout RayAnswer a) {
    const Record r = fetchRecord(record);
    if ((r.r0.w & RECORD_IS_NODE) != 0u) return;
    ++a.bruteRecords;
    const LeafPoints p = leafPoints(r);
    const TrianglePairHit hit = hitTrianglePair(p, ray);
    const bool isSphere = (r.r0.w & RECORD_IS_SPHERE) != 0u;
    const float first =
        isSphere ? hitSphere(p.p0, leafRadius(r), ray, q.tMin, q.tMax) : hit.first.t;
    const uint home = isSphere ? record : leafHome(r);
    tryOne(q, ray, 2u * home, first, p.p0, p.p1, p.p2, a);
    tryOne(q, ray, 2u * home + 1u, hit.second.t, p.p0, p.p2, p.p3, a);
}

RayAnswer answer(RayQuery q) {
    RayAnswer a =
        RayAnswer(0.0, 0.0, 0.0, NO_PRIMITIVE, 0u, 0u, 0u, q.tMax, 0u, 0u, 0u, 0u);
    Traversal t;
    Stack stack;
    startTraversal(t, stack, q.origin, q.direction, q.tMin, q.tMax, q.skipPrimitive, q.anyHit != 0u);
    const Ray ray = makeRay(q.origin, q.direction);
    traverse(t, stack, ray, a);
    for (uint record = 0u; record < dispatch.segmentBase; ++record)
        tryRecord(q, ray, record, a);
    return a;
}
