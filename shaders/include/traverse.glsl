// Traversal of the binary BVH in steps, so that lanes whose rays are done can be served while
// others go on (path.glsl). A step visits up to two nodes and tests at most one primitive: rays visit
// about twice as many nodes as primitives, and llvmpipe pays for both kinds of work in every step.

struct Traversal {
    Ray ray;
    float tMin; ///< hits at or before this do not count (camera clipping; 0 elsewhere)
    float tMax; ///< hits at or after this do not count; shrinks to the closest hit
    uint skipPrimitive; ///< the planar primitive the ray starts on
    bool anyHit; ///< stop at the first hit
    uint current; ///< child reference to visit next; CHILD_NONE: done
    uint stackTop;
    uint hitPrimitive; ///< NO_PRIMITIVE: nothing hit
    float b1, b2; ///< barycentric weights of the hit (triangles)
};

uint traversalStack[STACK_SIZE];

void startTraversal(out Traversal t, vec3 origin, vec3 direction, float tMin, float tMax,
                    uint skipPrimitive, bool anyHit) {
    t.ray = makeRay(origin, direction);
    t.tMin = tMin;
    t.tMax = tMax;
    t.skipPrimitive = skipPrimitive;
    t.anyHit = anyHit;
    t.hitPrimitive = NO_PRIMITIVE;
    t.b1 = 0.0;
    t.b2 = 0.0;
    t.stackTop = 0u;
    // A ray with a part that is not finite hits nothing: ordered comparisons are false for NaN.
    const vec3 size = abs(direction) + abs(origin);
    const bool finite = size.x + size.y + size.z < INFINITE_DISTANCE &&
                        dot(abs(direction), vec3(1.0)) > 0.0;
    t.current = finite ? 0u : CHILD_NONE;
}

void popTraversal(inout Traversal t) {
    const bool empty = t.stackTop == 0u;
    t.stackTop = empty ? 0u : t.stackTop - 1u;
    const uint top = traversalStack[t.stackTop];
    t.current = empty ? CHILD_NONE : top;
}

void visitNode(inout Traversal t) {
    const Node node = fetchNode(t.current);
    const float tLeft = enterBox(node.leftLow, node.leftHigh, t.ray, t.tMax);
    const float tRight = enterBox(node.rightLow, node.rightHigh, t.ray, t.tMax);
    const bool hitsLeft = tLeft < INFINITE_DISTANCE, hitsRight = tRight < INFINITE_DISTANCE;
    const bool leftFirst = hitsLeft && (!hitsRight || tLeft <= tRight);
    if (hitsLeft && hitsRight) {
        traversalStack[t.stackTop] = leftFirst ? node.right : node.left;
        ++t.stackTop;
    }
    t.current = leftFirst ? node.left : node.right;
    if (!hitsLeft && !hitsRight) popTraversal(t);
}

void acceptHit(inout Traversal t, float distance, uint primitive, float b1, float b2) {
    t.tMax = distance;
    t.hitPrimitive = primitive;
    t.b1 = b1;
    t.b2 = b2;
}

/// Tests the first primitive of the leaf run and moves on to the next one of the run.
void visitLeaf(inout Traversal t) {
    const uint first = t.current & CHILD_FIRST_MASK;
    const uint left = (t.current >> CHILD_COUNT_SHIFT) & (MAX_LEAF_PRIMITIVES - 1u);
    const Primitive p = fetchPrimitive(first);
    const bool isSphere = HAS_SPHERES && (!HAS_TRIANGLES || p.kind == PRIMITIVE_SPHERE);
    if (HAS_TRIANGLES && !isSphere) {
        const TriangleHit hit = hitTriangle(p.v0, p.v1, p.v2, t.ray);
        if (hit.t > t.tMin && hit.t < t.tMax && first != t.skipPrimitive)
            acceptHit(t, hit.t, first, hit.b1, hit.b2);
    }
    if (HAS_SPHERES && isSphere) {
        const float distance = hitSphere(p.v0, p.v1.x, t.ray, t.tMin, t.tMax);
        if (distance < INFINITE_DISTANCE) acceptHit(t, distance, first, 0.0, 0.0);
    }
    t.current = CHILD_LEAF_BIT | ((left - 1u) << CHILD_COUNT_SHIFT) | (first + 1u);
    if (left == 0u) popTraversal(t);
    if (t.anyHit && t.hitPrimitive != NO_PRIMITIVE) t.current = CHILD_NONE;
}

bool traversing(Traversal t) { return t.current != CHILD_NONE; }

void traversalStep(inout Traversal t) {
    if (t.current < CHILD_LEAF_BIT) visitNode(t);
    if (t.current < CHILD_LEAF_BIT) visitNode(t);
    if (t.current >= CHILD_LEAF_BIT && t.current != CHILD_NONE) visitLeaf(t);
}
