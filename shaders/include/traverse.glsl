// Traversal of the 8-wide BVH in steps, so that lanes whose rays are done can be served while
// others go on (path.glsl). A step visits one record, whatever its kind, so that lanes do not part
// ways (docs/theory/kernel.md, "What llvmpipe does").

#include "traversal_stack.glsl"
#include "placements.glsl"

struct Traversal {
    vec3 origin, direction;
    float tMin; ///< hits at or before this do not count (camera clipping; 0 elsewhere)
    float tMax; ///< hits at or after this do not count; shrinks to the closest hit
    uint skipPrimitive; ///< the planar primitive the ray starts on
    bool anyHit; ///< stop at the first hit
    Group group;          ///< children still to visit; empty: the ray is done
    uint hitPrimitive; ///< 2 * record + slot; NO_PRIMITIVE: nothing hit
    float b1, b2; ///< barycentric weights of the hit (triangles)
    uint passed; ///< HAS_ALPHA: the primitive that the ray has passed at tMin; NO_PRIMITIVE: none
    uint placement; ///< in whose prototype the traversal is; NO_PLACEMENT: in none
    bool waits; ///< for a ray that is prepared for another placement, or for the world
    uint hitPlacement, skipPlacement, passedPlacement; ///< of hitPrimitive, skipPrimitive and passed
    uint sphere; ///< SPHERES_WAIT: the record of one that has been met and not tested yet; NO_PRIMITIVE: none
};

/// Bit of Group::word, free in groups of two words: the group is one of the tree over the world.
const uint IN_WORLD = 0x100u;

// Where surfaces may be partly not there, a ray that passes one goes on from the same origin with tMin at that
// surface. Hits are ordered by distance and, at equal ones, by primitive, so that each of several surfaces at one
// distance is met exactly once. Distances of a ray and a primitive are the same bits in each traversal.

bool comesBefore(uint placement, uint place, uint otherPlacement, uint other) {
    if (HAS_PLACEMENTS && placement != otherPlacement) return placement < otherPlacement;
    return place < other;
}
bool comesAfterPassed(Traversal t, uint place) {
    return comesBefore(t.passedPlacement, t.passed, t.placement, place);
}
bool comesBeforeHit(Traversal t, uint place) {
    return comesBefore(t.placement, place, t.hitPlacement, t.hitPrimitive);
}

/// Hits of the primitive count behind this distance: tMin, or, if it comes after the one that was passed there, the
/// float before it. (A ray that has passed something has tMin > 0.)
float nearEnd(Traversal t, uint place) {
    if (HAS_ALPHA && t.passed != NO_PRIMITIVE && comesAfterPassed(t, place))
        return uintBitsToFloat(floatBitsToUint(t.tMin) - 1u);
    return t.tMin;
}

/// Hits of the primitive count before this distance: tMax, or, if it comes before the one that was hit there, the
/// float after it.
float farEnd(Traversal t, uint place) {
    if (HAS_ALPHA && t.hitPrimitive != NO_PRIMITIVE && comesBeforeHit(t, place))
        return uintBitsToFloat(floatBitsToUint(t.tMax) + 1u);
    return t.tMax;
}

/// Begins at the root. The ray's origin and direction, tMin, tMax, skipPrimitive and anyHit are set.
void startTraversal(inout Traversal t, inout Stack stack) {
    t.hitPrimitive = NO_PRIMITIVE;
    t.b1 = 0.0;
    t.b2 = 0.0;
    clear(stack);
    // A ray with a part that is not finite hits nothing: ordered comparisons are false for NaN.
    const float size = dot(abs(t.direction), vec3(1.0));
    const bool finite = size > 0.0 && size + dot(abs(t.origin), vec3(1.0)) < INFINITE_DISTANCE;
    // The root is slot 0 of a group that begins at record 0.
    t.group = finite ? makeGroup(0u, 1u << octantOf(t.direction)) : noGroup();
    if (HAS_PLACEMENTS && finite) t.group.word |= IN_WORLD;
    t.placement = NO_PLACEMENT;
    t.hitPlacement = NO_PLACEMENT;
    t.waits = false;
    t.sphere = NO_PRIMITIVE;
}

void startTraversal(out Traversal t, inout Stack stack, vec3 origin, vec3 direction, float tMin, float tMax,
                    uint skipPrimitive, bool anyHit) {
    t.origin = origin;
    t.direction = direction;
    t.tMin = tMin;
    t.tMax = tMax;
    t.skipPrimitive = skipPrimitive;
    t.anyHit = anyHit;
    t.passed = NO_PRIMITIVE;
    t.skipPlacement = NO_PLACEMENT;
    startTraversal(t, stack);
}

bool traversing(Traversal t) { return !isEmpty(t.group); }

void endTraversal(inout Traversal t) { t.group.word = 0u; }

/// The ray that the next steps are for: `prepared`, or that in the placement that the traversal is in.
Ray prepareLeg(inout Traversal t, Ray prepared) {
    Ray ray = prepared;
    if (HAS_PLACEMENTS) {
        aimAtPrototype(ray, t.placement);
        // What waits in a placement is its root, which is slot 0 of a group.
        if (t.waits && t.placement != NO_PLACEMENT) t.group.word = 1u << ray.octant;
        t.waits = false;
    }
    return ray;
}

/// Whether the primitive is the one that the ray starts on.
bool isSkipped(Traversal t, uint place) {
    if (HAS_PLACEMENTS && t.placement != t.skipPlacement) return false;
    return place == t.skipPrimitive;
}

void acceptTriangle(inout Traversal t, TriangleHit hit, uint place, bool isLeaf) {
    const bool accepted = isLeaf && hit.t > nearEnd(t, place) && hit.t < farEnd(t, place) &&
                          !isSkipped(t, place);
    t.tMax = accepted ? hit.t : t.tMax;
    t.b1 = accepted ? hit.b1 : t.b1;
    t.b2 = accepted ? hit.b2 : t.b2;
    t.hitPrimitive = accepted ? place : t.hitPrimitive;
    t.hitPlacement = accepted ? t.placement : t.hitPlacement;
}

void testSphere(inout Traversal t, Ray ray, vec3 center, float radius, uint record, bool isSphere) {
    const uint place = 2u * record;
    const float distance = hitSphere(center, radius, ray, nearEnd(t, place), farEnd(t, place));
    if (isSphere && distance < INFINITE_DISTANCE) {
        t.tMax = distance;
        t.hitPrimitive = place;
        t.hitPlacement = NO_PLACEMENT;
    }
}

/// Tests the one or two triangles of a leaf, or its sphere.
void testLeaf(inout Traversal t, Ray ray, Record r, uint record, bool isLeaf) {
    if (HAS_TRIANGLES) {
        const TrianglePairHit hit = hitTrianglePair(pointsInWorld(leafPoints(r), ray), ray);
        acceptTriangle(t, hit.first, 2u * leafHome(r), isLeaf);
        acceptTriangle(t, hit.second, 2u * leafHome(r) + 1u, isLeaf);
    }
    if (HAS_SPHERES && !SPHERES_WAIT)
        testSphere(t, ray, uintBitsToFloat(r.r0.xyz), leafRadius(r), record, isLeaf && (r.r0.w & RECORD_IS_SPHERE) != 0u);
}

/// Where spheres are few, a step does not test the one that it meets: that waits for this, after some steps.
void testWaitingSphere(inout Traversal t, Ray ray) {
    if (!SPHERES_WAIT) return;
    const bool isThere = t.sphere != NO_PRIMITIVE;
    const uint record = isThere ? t.sphere : 0u, row = RECORD_ROWS * record;
    const vec3 center = uintBitsToFloat(ROW(recordRows, row).xyz);
    testSphere(t, ray, center, uintBitsToFloat(ROW(recordRows, row + 3u).w), record, isThere);
    t.sphere = NO_PRIMITIVE;
    if (t.anyHit && t.hitPrimitive != NO_PRIMITIVE) endTraversal(t);
}

/// What a record is, by its word 3.
struct RecordKind {
    bool isNode, isPlacement;
};

RecordKind kindOf(Record r) {
    const uint kind = r.r0.w & RECORD_IS_PLACEMENT;
    if (HAS_PLACEMENTS) return RecordKind(kind == RECORD_IS_NODE, kind == RECORD_IS_PLACEMENT);
    return RecordKind((r.r0.w & RECORD_IS_NODE) != 0u, false);
}

/// Goes into a prototype, or back to the world, for which another ray has to be prepared.
void changeSpace(inout Traversal t, bool enters, uint record, Record r) {
    if (enters) {
        t.placement = record;
        t.group = Group(1u, r.r0.x); // prepareRay() says which bit it is
    }
    const bool leaves = !enters && t.placement != NO_PLACEMENT && (t.group.word & IN_WORLD) != 0u;
    if (leaves) t.placement = NO_PLACEMENT;
    t.waits = t.waits || enters || leaves;
}

/// Whether a ray may wait with the group that it has.
const bool GROUPS_STAY = HAS_PLACEMENTS || SPHERES_WAIT;

/// Visits the next record. Where lanes are those of SIMD registers, both sides of an `if` are executed, and a branch
/// costs more than it saves: a ray that is done visits the root to no effect (docs/theory/kernel.md, "What llvmpipe does").
/// STEPS_BRANCH: a GPU leaves out the half of a step that none of its lanes needs.
void traversalStep(inout Traversal t, inout Stack stack, Ray ray) {
    bool working = traversing(t);
    if (HAS_PLACEMENTS) working = working && !t.waits;
    const uint next = nearestSlot(t.group);
    const uint record = working ? firstRecord(t.group) + (next ^ ray.octant) : 0u;
    const Group rest = without(t.group, next);

    const Record r = fetchRecord(record);
    const RecordKind kind = kindOf(r);
    // A ray that has passed surfaces begins at its origin again, and leaves out what lies before them.
    float begin = 0.0;
    if (HAS_ALPHA) begin = t.tMin;
    bool isSphere = false;
    if (SPHERES_WAIT) {
        isSphere = working && !kind.isNode && (r.r0.w & RECORD_IS_SPHERE) != 0u;
        // The second one that is met stays where it is until the first one has been tested.
        const bool isFirst = t.sphere == NO_PRIMITIVE;
        t.sphere = isSphere && isFirst ? record : t.sphere;
        working = working && (!isSphere || isFirst);
    }
    const bool isLeaf = working && !isSphere && !kind.isNode && !kind.isPlacement;
    uint entered = 0u;
    if (!STEPS_BRANCH || kind.isNode) entered = enterChildren(r, ray, begin, t.tMax);
    if (!STEPS_BRANCH || isLeaf) testLeaf(t, ray, r, record, isLeaf);

    const bool descend = working && kind.isNode && entered != 0u;
    const bool goesDown = descend || working && kind.isPlacement;
    const bool push = goesDown && !isEmpty(rest);
    const bool pop = working && !goesDown && isEmpty(rest);
    const Group newest = moveStack(stack, push, pop, rest);
    Group children = makeGroup(r.r0.w, entered);
    if (HAS_PLACEMENTS) children.word |= t.group.word & IN_WORLD;
    const Group after = select(descend, children, select(pop, newest, rest));
    t.group = select(working || !GROUPS_STAY, after, t.group); // what waits stays
    if (HAS_PLACEMENTS) changeSpace(t, working && kind.isPlacement, record, r);
    if (t.anyHit && t.hitPrimitive != NO_PRIMITIVE) endTraversal(t);
}
