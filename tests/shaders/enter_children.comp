#version 460
#extension GL_GOOGLE_include_directive : require
#include "prelude.glsl"
#include "naive.glsl"

QUERIES_AND_ANSWERS(NodeQuery, NodeAnswer)

Record recordOf(uint w[16]) {
    return Record(uvec4(w[0], w[1], w[2], w[3]), uvec4(w[4], w[5], w[6], w[7]),
                  uvec4(w[8], w[9], w[10], w[11]), uvec4(w[12], w[13], w[14], w[15]));
}

float plane(uint word, uvec2 bytes, uint slot) {
    const uint q = (bytes[slot >> 2u] >> (8u * (slot & 3u))) & 0xFFu;
    return uintBitsToFloat(word & 0xFFFFFF00u) + float(q) * uintBitsToFloat((word & 0xFFu) << 23u);
}

/// The children's boxes decoded one by one, as NodeRecord says.
uint enterNaively(Record r, Ray ray, float tMax) {
    uint entered = 0u;
    for (uint slot = 0u; slot < WIDE_CHILDREN; ++slot) {
        const vec3 low = vec3(plane(r.r0.x, r.r1.xy, slot), plane(r.r0.y, r.r2.xy, slot),
                              plane(r.r0.z, r.r3.xy, slot));
        const vec3 high = vec3(plane(r.r0.x, r.r1.zw, slot), plane(r.r0.y, r.r2.zw, slot),
                               plane(r.r0.z, r.r3.zw, slot));
        if (enterBoxNaively(low, high, ray, tMax) < INFINITE_DISTANCE) entered |= 1u << slot;
    }
    return entered;
}

NodeAnswer answer(NodeQuery q) {
    const Ray ray = makeRay(q.origin, q.direction);
    const Record r = recordOf(q.record);
    return NodeAnswer(enterChildren(r, ray, 0.0, q.tMax), ray.octant, enterNaively(r, ray, q.tMax),
                      highestBit(q.number));
}
