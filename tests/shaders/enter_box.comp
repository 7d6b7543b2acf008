#version 460
#extension GL_GOOGLE_include_directive : require
#include "prelude.glsl"
#include "naive.glsl"

QUERIES_AND_ANSWERS(BoxQuery, BoxAnswer)

BoxAnswer answer(BoxQuery q) {
    const Ray ray = makeRay(q.origin, q.direction);
    return BoxAnswer(enterBox(q.low, q.high, ray, q.tMax),
                     enterBoxNaively(q.low, q.high, ray, q.tMax));
}
