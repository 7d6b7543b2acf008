#version 460
#extension GL_GOOGLE_include_directive : require
#include "prelude.glsl"

QUERIES_AND_ANSWERS(LightQuery, LightAnswer)

bool blocked(vec3 origin, vec3 direction, float tMax) {
    Traversal t;
    Stack stack;
    startTraversal(t, stack, origin, direction, 0.0, tMax, NO_PRIMITIVE, true);
    const Ray ray = makeRay(origin, direction);
    for (uint i = 0u; traversing(t) && i < 1000u; ++i)
        traversalStep(t, stack, ray);
    return t.hitPrimitive != NO_PRIMITIVE;
}

LightAnswer answer(LightQuery q) {
    const SurfacePoint s = SurfacePoint(q.position, largestComponent(q.error), q.geometric, q.shading,
                                        q.wo, q.outside != 0u, 0u, NO_PRIMITIVE, 0.0 NO_DETAIL);
    Given given;
    given.frame = frame;
    given.onlyLight = findOnlyLight();
    given.roots = findRoots(frame);
    const vec2 u = vec2(q.u, q.v);
    PickedLight picked;
    float again = 0.0;
    if (q.light == NO_LIGHT) {
        picked = pickLight(given, litPoint(s), shadingNormal(s), 0u, u);
    } else {
        const LightEntry entry = lightEntry(given.roots, q.light);
        again = lightProbability(given, entry, litPoint(s), shadingNormal(s));
        picked = PickedLight(entry.light, 1.0, u);
    }
    MaterialPoint emitter;
    LightSample l = sampleLight(given, s, picked.light, picked.u, emitter);
    if (emissionHasFactors() && emitter.primitive != NO_PRIMITIVE)
        l.radiance *= emissionFactorOf(lookUpMaterial(emitter));
    const bool below = dot(s.geometric, l.direction) < 0.0;
    const vec3 origin = leave(s, l.direction, below); // as traceDirectSample() in path.glsl
    const bool isBlocked = l.infinite ? blocked(origin, l.direction, INFINITE_DISTANCE)
                                      : blocked(origin, l.target - origin, 1.0);
    const vec3 radiance = picked.probability > 0.0 ? l.radiance / picked.probability : vec3(0.0);
    return LightAnswer(l.target, l.infinite ? 1u : 0u, l.direction, isBlocked ? 1u : 0u, radiance,
                       picked.light, picked.probability, again, picked.u.x, picked.u.y);
}
