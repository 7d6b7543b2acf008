#version 460
#extension GL_GOOGLE_include_directive : require
#include "prelude.glsl"
#include "naive.glsl"

QUERIES_AND_ANSWERS(SphereQuery, SphereAnswer)

SphereAnswer answer(SphereQuery q) {
    const Ray ray = makeRay(q.origin, q.direction);
    return SphereAnswer(hitSphere(q.center, q.radius, ray, q.tMin, q.tMax),
                        hitSphereNaively(q.center, q.radius, ray, q.tMin, q.tMax));
}
