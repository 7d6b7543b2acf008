// Prototypes in the world (scene_types.h): boxes of their trees are met in the prototype's space, triangles in the
// world, where their corners are the same bits for every ray (docs/theory/numerics.md, "Instances").


/// The point that the rows of an affine transformation place p at. Sums are taken in this order, and not contracted,
/// so that scene/model/placements.cpp and the tests find the same bits.
vec3 placed(vec4 row0, vec4 row1, vec4 row2, vec3 p) {
    precise float x = ((row0.x * p.x + row0.y * p.y) + row0.z * p.z) + row0.w;
    precise float y = ((row1.x * p.x + row1.y * p.y) + row1.z * p.z) + row1.w;
    precise float z = ((row2.x * p.x + row2.y * p.y) + row2.z * p.z) + row2.w;
    return vec3(x, y, z);
}

vec3 turned(vec4 row0, vec4 row1, vec4 row2, vec3 v) {
    return vec3(dot(row0.xyz, v), dot(row1.xyz, v), dot(row2.xyz, v));
}

PlacementRecord fetchPlacement(uint record) {
    const Record r = fetchRecord(record);
    return PlacementRecord(r.r0.x, r.r0.y, r.r0.z, r.r0.w, uintBitsToFloat(r.r1),
                           uintBitsToFloat(r.r2), uintBitsToFloat(r.r3));
}

TransformRecord fetchTransform(uint record) {
    const Record r = fetchRecord(record);
    return TransformRecord(uintBitsToFloat(r.r0), uintBitsToFloat(r.r1), uintBitsToFloat(r.r2),
                           uintBitsToFloat(r.r3.x), r.r3.y, r.r3.z, r.r3.w);
}

/// Turns a ray of the world into one that meets the boxes of a placement's prototype.
void aimAtPrototype(inout Ray ray, uint placement) {
    const bool isInside = placement != NO_PLACEMENT;
    const PlacementRecord p = fetchPlacement(placement);
    const TransformRecord t = fetchTransform(isInside ? p.transform : 0u);
    const vec3 away = ray.origin - vec3(t.toWorld0.w, t.toWorld1.w, t.toWorld2.w);
    const vec3 origin = turned(p.toPrototype0, p.toPrototype1, p.toPrototype2, away);
    const vec3 direction = turned(p.toPrototype0, p.toPrototype1, p.toPrototype2, ray.direction);
    const vec3 slack = vec3(p.toPrototype0.w, p.toPrototype1.w, p.toPrototype2.w) *
                       (largestComponent(abs(away)) + t.reach);
    prepareForBoxes(ray, isInside ? origin : ray.origin, isInside ? direction : ray.direction);
    ray.slack = isInside ? slack * abs(ray.inverse) : vec3(0.0);
    ray.toWorld0 = isInside ? t.toWorld0 : ray.toWorld0;
    ray.toWorld1 = isInside ? t.toWorld1 : ray.toWorld1;
    ray.toWorld2 = isInside ? t.toWorld2 : ray.toWorld2;
}

/// The points of a leaf in the world.
LeafPoints pointsInWorld(LeafPoints p, Ray ray) {
    if (!HAS_PLACEMENTS) return p;
    return LeafPoints(placed(ray.toWorld0, ray.toWorld1, ray.toWorld2, p.p0),
                      placed(ray.toWorld0, ray.toWorld1, ray.toWorld2, p.p1),
                      placed(ray.toWorld0, ray.toWorld1, ray.toWorld2, p.p2),
                      placed(ray.toWorld0, ray.toWorld1, ray.toWorld2, p.p3));
}

