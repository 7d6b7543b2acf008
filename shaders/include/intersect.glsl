// Ray against box, triangle and sphere. The bounds used here are derived in docs/numerics.md.

/// A ray with what its intersection tests need. Distances are in units of the direction's length.
struct Ray {
    vec3 origin;
    vec3 direction;
    vec3 inverse;  ///< reciprocal direction, finite (boxes)
    uint axis;     ///< largest component of the direction (triangles)
    vec3 shear;    ///< maps the direction to the z axis (triangles)
};

/// Woop's permutation: the component `axis` becomes z. Cyclic, so orientation is kept.
vec3 permute(vec3 v, uint axis) {
    return axis == 2u ? v : (axis == 0u ? v.yzx : v.zxy);
}

Ray makeRay(vec3 origin, vec3 direction) {
    Ray ray;
    ray.origin = origin;
    ray.direction = direction;
    const vec3 a = abs(direction);
    const float largest = max(a.x, max(a.y, a.z));
    // A component below 2^-40 of the largest is taken as that in box tests: it moves the ray by
    // less than the rounding of its own coordinates, and keeps 0 * infinity away.
    const vec3 sign = mix(vec3(1.0), vec3(-1.0), lessThan(direction, vec3(0.0)));
    ray.inverse = 1.0 / (sign * max(a, vec3(largest * 9.094947017729282e-13)));
    ray.axis = a.z == largest ? 2u : (a.x == largest ? 0u : 1u);
    const vec3 d = permute(direction, ray.axis);
    ray.shear = vec3(d.x / d.z, d.y / d.z, 1.0 / d.z);
    return ray;
}

/// Where the ray enters the box, at least 0, or INFINITE_DISTANCE if it misses it within
/// [0, tMax]. Conservative: never misses a box it touches, nor one that holds a primitive at tMax;
/// docs/numerics.md derives the slack (after Ize 2013). Planes are chosen by the direction's sign:
/// sorting the two distances would turn the inverted box of an absent child into a huge one.
float enterBox(vec3 low, vec3 high, Ray ray, float tMax) {
    const bvec3 negative = lessThan(ray.inverse, vec3(0.0));
    const vec3 nearest = (mix(low, high, negative) - ray.origin) * ray.inverse;
    const vec3 farthest = (mix(high, low, negative) - ray.origin) * ray.inverse;
    // As integers, bit patterns of floats that are not negative compare as the floats do, and a
    // negative one is below them all, which is all that is needed here. llvmpipe takes one
    // instruction for it, and three for a float minimum that minds NaN.
    const ivec3 n = floatBitsToInt(nearest), f = floatBitsToInt(farthest);
    const float tNear = intBitsToFloat(max(max(n.x, n.y), max(n.z, 0)));
    const float tFar = intBitsToFloat(min(min(f.x, f.y), min(f.z, floatBitsToInt(tMax))));
    return tNear <= tFar * BOX_SLACK ? tNear : INFINITE_DISTANCE;
}

struct TriangleHit {
    float t; ///< INFINITE_DISTANCE: no hit
    float b1, b2; ///< barycentric weights of v1 and v2
};

/// Watertight ray-triangle test (Woop, Benthin and Wald 2013). A vertex is mapped to the same bits
/// in every triangle that shares it, and the two products of an edge function are rounded alike
/// in both triangles of an edge; since rounding is monotonic, the difference of the rounded
/// products is never of the wrong sign, at worst zero, and zero counts as inside: no ray passes
/// between two triangles. `precise` keeps the products from being fused.
TriangleHit hitTriangle(vec3 v0, vec3 v1, vec3 v2, Ray ray) {
    precise vec3 a = permute(v0 - ray.origin, ray.axis);
    precise vec3 b = permute(v1 - ray.origin, ray.axis);
    precise vec3 c = permute(v2 - ray.origin, ray.axis);
    precise vec2 as = a.xy - ray.shear.xy * a.z;
    precise vec2 bs = b.xy - ray.shear.xy * b.z;
    precise vec2 cs = c.xy - ray.shear.xy * c.z;
    precise float u = cs.x * bs.y - cs.y * bs.x;
    precise float v = as.x * cs.y - as.y * cs.x;
    precise float w = bs.x * as.y - bs.y * as.x;
    const float determinant = u + v + w;
    const bool inside = (min(u, min(v, w)) >= 0.0 || max(u, max(v, w)) <= 0.0) &&
                        determinant != 0.0;
    // Weights first: the product of an edge function and a distance may overflow.
    const float inverse = 1.0 / determinant;
    const float b0 = u * inverse, b1 = v * inverse, b2 = w * inverse;
    const float t = (b0 * a.z + b1 * b.z + b2 * c.z) * ray.shear.z;
    return TriangleHit(inside ? t : INFINITE_DISTANCE, b1, b2);
}

/// Nearest t in (tMin, tMax) at which the ray meets the sphere, or INFINITE_DISTANCE. The
/// discriminant comes from the distance of the line to the centre, not from b^2 - 4ac, which
/// has no correct digit left once the sphere is 4096 radii away. The perpendicular is found in two
/// steps: after the first, rounding leaves a part along the line of some 2^-22 of the distance.
/// The root that would cancel comes from the product of the roots.
float hitSphere(vec3 center, float radius, Ray ray, float tMin, float tMax) {
    const float inverseLength2 = 1.0 / dot(ray.direction, ray.direction);
    const vec3 f = ray.origin - center;
    const float nearlyClosest = -dot(f, ray.direction) * inverseLength2;
    const vec3 nearlyPerpendicular = f + nearlyClosest * ray.direction;
    const float correction = -dot(nearlyPerpendicular, ray.direction) * inverseLength2;
    const float closest = nearlyClosest + correction;
    const float distance = length(nearlyPerpendicular + correction * ray.direction);
    const float discriminant = (radius - distance) * (radius + distance) * inverseLength2;
    const float s = sqrt(max(discriminant, 0.0));
    const float q = closest + (closest >= 0.0 ? s : -s);
    const float fromOrigin = length(f);
    const float product = (fromOrigin - radius) * (fromOrigin + radius) * inverseLength2;
    const float other = q != 0.0 ? product / q : INFINITE_DISTANCE;
    const float t0 = min(q, other), t1 = max(q, other);
    const float t = t0 > tMin ? t0 : t1;
    return discriminant >= 0.0 && t > tMin && t < tMax ? t : INFINITE_DISTANCE;
}
