// Traversal of the 8-wide BVH in steps, so that lanes whose rays are done can be served while
// others go on (path.glsl). A step visits one record, whatever its kind, so that lanes do not part
// ways (docs/kernel.md, "What llvmpipe does").

#include "traversal_stack.glsl"

struct Traversal {
    vec3 origin, direction;
    float tMin; ///< hits at or before this do not count (camera clipping; 0 elsewhere)
    float tMax; ///< hits at or after this do not count; shrinks to the closest hit
    uint skipPrimitive; ///< the planar primitive the ray starts on
    bool anyHit; ///< stop at the first hit
    Group group;          ///< children still to visit; empty: the ray is done
    uint hitPrimitive; ///< 2 * record + slot; NO_PRIMITIVE: nothing hit
    float b1, b2; ///< barycentric weights of the hit (triangles)
#ifdef RICH_MATERIALS
    uint passed; ///< HAS_ALPHA: the primitive that the ray has passed at tMin; NO_PRIMITIVE: none
#endif
};

// Where surfaces may be partly not there, a ray that passes one goes on from the same origin with tMin at that
// surface. Hits are ordered by distance and, at equal ones, by primitive, so that each of several surfaces at one
// distance is met exactly once. Distances of a ray and a primitive are the same bits in each traversal.

/// Hits of the primitive count behind this distance: tMin, or, if it comes after the one that was passed there, the
/// float before it. (A ray that has passed something has tMin > 0.)
float nearEnd(Traversal t, uint place) {
#ifdef RICH_MATERIALS
    if (HAS_ALPHA && t.passed != NO_PRIMITIVE && place > t.passed)
        return uintBitsToFloat(floatBitsToUint(t.tMin) - 1u);
#endif
    return t.tMin;
}

/// Hits of the primitive count before this distance: tMax, or, if it comes before the one that was hit there, the
/// float after it.
float farEnd(Traversal t, uint place) {
#ifdef RICH_MATERIALS
    if (HAS_ALPHA && t.hitPrimitive != NO_PRIMITIVE && place < t.hitPrimitive)
        return uintBitsToFloat(floatBitsToUint(t.tMax) + 1u);
#endif
    return t.tMax;
}

/// Begins at the root. The ray's origin and direction, tMin, tMax, skipPrimitive and anyHit are set.
void startTraversal(inout Traversal t) {
    t.hitPrimitive = NO_PRIMITIVE;
    t.b1 = 0.0;
    t.b2 = 0.0;
    clearStack();
    // A ray with a part that is not finite hits nothing: ordered comparisons are false for NaN.
    const float size = dot(abs(t.direction), vec3(1.0));
    const bool finite = size > 0.0 && size + dot(abs(t.origin), vec3(1.0)) < INFINITE_DISTANCE;
    // The root is slot 0 of a group that begins at record 0.
    t.group = finite ? makeGroup(0u, 1u << octantOf(t.direction)) : noGroup();
}

void startTraversal(out Traversal t, vec3 origin, vec3 direction, float tMin, float tMax,
                    uint skipPrimitive, bool anyHit) {
    t.origin = origin;
    t.direction = direction;
    t.tMin = tMin;
    t.tMax = tMax;
    t.skipPrimitive = skipPrimitive;
    t.anyHit = anyHit;
#ifdef RICH_MATERIALS
    t.passed = NO_PRIMITIVE;
#endif
    startTraversal(t);
}

bool traversing(Traversal t) { return !isEmpty(t.group); }

void endTraversal(inout Traversal t) { t.group.word = 0u; }

void acceptTriangle(inout Traversal t, TriangleHit hit, uint place, bool isLeaf) {
    const bool accepted = isLeaf && hit.t > nearEnd(t, place) && hit.t < farEnd(t, place) &&
                          place != t.skipPrimitive;
    t.tMax = accepted ? hit.t : t.tMax;
    t.b1 = accepted ? hit.b1 : t.b1;
    t.b2 = accepted ? hit.b2 : t.b2;
    t.hitPrimitive = accepted ? place : t.hitPrimitive;
}

/// Tests the one or two triangles of a leaf, or its sphere.
void testLeaf(inout Traversal t, Ray ray, Record r, uint record, bool isLeaf) {
    if (HAS_TRIANGLES) {
        const TrianglePairHit hit = hitTrianglePair(leafPoints(r), ray);
        acceptTriangle(t, hit.first, 2u * record, isLeaf);
        acceptTriangle(t, hit.second, 2u * record + 1u, isLeaf);
    }
    if (HAS_SPHERES) {
        const vec3 center = uintBitsToFloat(r.r0.xyz);
        const uint place = 2u * record;
        const float distance =
            hitSphere(center, leafRadius(r), ray, nearEnd(t, place), farEnd(t, place));
        const bool isSphere = isLeaf && (r.r0.w & RECORD_IS_SPHERE) != 0u;
        if (isSphere && distance < INFINITE_DISTANCE) {
            t.tMax = distance;
            t.hitPrimitive = 2u * record;
        }
    }
}

/// Visits the next record. A ray that is done visits the root to no effect, which costs less than an `if`
/// around all this (docs/kernel.md, "What llvmpipe does").
void traversalStep(inout Traversal t, Ray ray) {
    const bool working = traversing(t);
    const uint next = nearestSlot(t.group);
    const uint record = working ? firstRecord(t.group) + (next ^ ray.octant) : 0u;
    const Group rest = without(t.group, next);

    const Record r = fetchRecord(record);
    const bool isNode = (r.r0.w & RECORD_IS_NODE) != 0u;
    const uint entered = enterChildren(r, ray, t.tMax);
    testLeaf(t, ray, r, record, working && !isNode);

    const bool descend = working && isNode && entered != 0u;
    const bool push = descend && !isEmpty(rest);
    const bool pop = working && !descend && isEmpty(rest);
    const Group newest = moveStack(push, pop, rest);
    const Group children = makeGroup(r.r0.w, entered);
    t.group = select(descend, children, select(pop, newest, rest));
    if (t.anyHit && t.hitPrimitive != NO_PRIMITIVE) endTraversal(t);
}
