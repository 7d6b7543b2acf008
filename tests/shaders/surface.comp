#version 460
#extension GL_GOOGLE_include_directive : require
#include "prelude.glsl"

QUERIES_AND_ANSWERS(SurfaceQuery, SurfaceAnswer)

/// What one primitive, on its own, does to a ray.
Traversal hitOne(uint primitive, vec3 origin, vec3 direction) {
    Traversal t;
    startTraversal(t, origin, direction, 0.0, INFINITE_DISTANCE, NO_PRIMITIVE, false);
    t.current = CHILD_LEAF_BIT | primitive; // a leaf of one
    visitLeaf(t);
    return t;
}

SurfaceAnswer answer(SurfaceQuery q) {
    const Traversal hit = hitOne(q.primitive, q.origin, q.direction);
    SurfacePoint s = surfaceAt(hit);
    SurfaceAnswer a;
    a.position = s.position;
    a.t = hit.tMax;
    a.error = s.error;
    a.shading = s.shading;
    a.outside = s.outside ? 1u : 0u;
    a.skipPrimitive = s.skipPrimitive;
    faceForward(s);
    a.geometric = s.geometric;
    a.facing = s.shading;
    a.start = leave(s, q.leaving);
    a.again = hitOne(q.primitive, a.start, q.leaving).tMax;
    a.unused0 = 0u;
    a.unused1 = 0u;
    return a;
}
