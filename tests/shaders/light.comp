#version 460
#extension GL_GOOGLE_include_directive : require
#include "prelude.glsl"

QUERIES_AND_ANSWERS(LightQuery, LightAnswer)

bool blocked(vec3 origin, vec3 direction, float tMax) {
    Traversal t;
    startTraversal(t, origin, direction, 0.0, tMax, NO_PRIMITIVE, true);
    const Ray ray = makeRay(origin, direction);
    for (uint i = 0u; traversing(t) && i < 1000u; ++i)
        traversalStep(t, ray);
    return t.hitPrimitive != NO_PRIMITIVE;
}

LightAnswer answer(LightQuery q) {
    const SurfacePoint s = SurfacePoint(q.position, largestComponent(q.error), q.geometric, q.shading,
                                        q.wo, q.outside != 0u, 0u, NO_PRIMITIVE, 0.0);
    const Light light = fetchLight(q.light);
    // One number for both the column of an alias table and the choice within it: three are enough
    // for the small tables of the tests.
    const float within = fract(q.w * float(light.entryCount));
    const LightSample l = sampleLight(s, light, vec4(q.u, q.v, q.w, within));
    const bool below = dot(s.geometric, l.direction) < 0.0;
    const vec3 origin = leave(s, l.direction, below); // as sampleLights in path.glsl
    const bool isBlocked = l.infinite ? blocked(origin, l.direction, INFINITE_DISTANCE)
                                      : blocked(origin, l.target - origin, 1.0);
    return LightAnswer(l.target, l.infinite ? 1u : 0u, l.direction, isBlocked ? 1u : 0u,
                       l.radiance, 0u);
}
