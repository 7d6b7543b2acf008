#version 460
#extension GL_GOOGLE_include_directive : require
#include "prelude.glsl"

QUERIES_AND_ANSWERS(SurfaceQuery, SurfaceAnswer)

/// What one primitive, on its own, does to a ray: the other slot of its leaf is skipped.
Traversal hitOne(uint place, vec3 origin, vec3 direction) {
    Traversal t;
    Stack stack;
    startTraversal(t, stack, origin, direction, 0.0, INFINITE_DISTANCE, place ^ 1u, false);
    const uint record = place >> 1u;
    testLeaf(t, makeRay(origin, direction), fetchRecord(record), record, true);
    return t;
}

SurfaceAnswer answer(SurfaceQuery q) {
    const Traversal hit = hitOne(q.place, q.origin, q.direction);
    SurfacePoint s = surfaceAt(hit);
    SurfaceAnswer a;
    a.position = s.position;
    a.t = hit.tMax;
    a.error = vec3(s.error);
    a.shading = s.shading;
    a.outside = s.outside ? 1u : 0u;
    a.skipPrimitive = s.skipPrimitive;
    faceForward(s);
    a.geometric = s.geometric;
    a.facing = shadingNormal(s);
    a.start = leave(s, q.leaving, dot(s.geometric, q.leaving) < 0.0);
    a.again = hitOne(q.place, a.start, q.leaving).tMax;
    a.lift = s.lift;
    a.unused = 0u;
    return a;
}
