// Ray against box, triangle and sphere. The bounds used here are derived in docs/theory/numerics.md.

/// A ray with what its intersection tests need, all of which follows from origin and direction. Distances
/// are in units of the direction's length.
struct Ray {
    vec3 origin;
    vec3 direction;
    vec3 inverse;      ///< reciprocal direction, finite (boxes)
    bool ascends[3];   ///< the direction is not negative on an axis (boxes)
    uint octant;       ///< bit k: the same for axis k
    uvec4 childBits[2]; ///< of slots 0-3 and 4-7: bit (slot ^ octant)
    bool xIsLargest, yIsLargest; ///< component of the direction (triangles); neither: z
    vec3 shear; ///< maps the direction to the z axis (triangles)
    float inverseLength2; ///< of the direction (spheres)
    vec3 boxOrigin; ///< of the ray in the space of the boxes, which `inverse` to `childBits` are of, too
    vec3 slack; ///< by how much planes of boxes move, in distance along the ray (placements.glsl)
    vec4 toWorld0, toWorld1, toWorld2; ///< rows of the matrix from that space to the triangles'
};

vec3 boxOrigin(Ray ray) { return ray.boxOrigin; }
vec3 boxSlack(Ray ray) { return HAS_PLACEMENTS ? ray.slack : vec3(0.0); }

/// The direction's largest component becomes z, and z takes its place: two selections fewer than Woop's cyclic
/// permutation, and nothing here asks for the orientation of triangles.
vec3 permute(vec3 v, Ray ray) {
    return vec3(ray.xIsLargest ? v.z : v.x, ray.yIsLargest ? v.z : v.y,
                ray.xIsLargest ? v.x : (ray.yIsLargest ? v.y : v.z));
}

/// Bit k is set where the direction's component k is not negative.
uint octantOf(vec3 direction) {
    return (direction.x < 0.0 ? 0u : 1u) | (direction.y < 0.0 ? 0u : 2u) |
           (direction.z < 0.0 ? 0u : 4u);
}

/// Fills in what box tests need.
void prepareForBoxes(inout Ray ray, vec3 origin, vec3 direction) {
    for (uint k = 0u; k < 3u; ++k)
        ray.ascends[k] = !(direction[k] < 0.0);
    ray.octant = octantOf(direction);
    ray.childBits[0] = uvec4(1u) << (uvec4(0u, 1u, 2u, 3u) ^ ray.octant);
    ray.childBits[1] = uvec4(1u) << (uvec4(4u, 5u, 6u, 7u) ^ ray.octant);
    const vec3 a = abs(direction);
    // A component below 2^-60 of the largest is taken as that in box tests, which keeps
    // 0 * infinity and infinity - infinity away (docs/theory/numerics.md).
    const vec3 sign = mix(vec3(1.0), vec3(-1.0), lessThan(direction, vec3(0.0)));
    const float least = largestComponent(a) * 8.673617379884035e-19;
    ray.inverse = 1.0 / (sign * vec3(larger(a.x, least), larger(a.y, least), larger(a.z, least)));
    ray.boxOrigin = origin;
    ray.slack = vec3(0.0);
}

Ray makeRay(vec3 origin, vec3 direction) {
    Ray ray;
    ray.origin = origin;
    ray.direction = direction;
    prepareForBoxes(ray, origin, direction);
    const vec3 a = abs(direction);
    const float largest = largestComponent(a);
    ray.xIsLargest = a.z != largest && a.x == largest;
    ray.yIsLargest = a.z != largest && a.x != largest;
    const vec3 d = permute(direction, ray);
    const float inverseZ = permute(ray.inverse, ray).z;
    ray.shear = vec3(d.xy * inverseZ, inverseZ);
    ray.inverseLength2 = 1.0 / dot(direction, direction);
    ray.toWorld0 = vec4(1.0, 0.0, 0.0, 0.0);
    ray.toWorld1 = vec4(0.0, 1.0, 0.0, 0.0);
    ray.toWorld2 = vec4(0.0, 0.0, 1.0, 0.0);
    return ray;
}

/// Position of the highest bit of x, 1 to 255: the exponent of x as a float
/// (docs/theory/kernel.md, "Arithmetic").
uint highestBit(uint x) { return (floatBitsToUint(float(int(x))) >> 23u) - 127u; }

/// Planes of a node's grid along a ray: plane q of an axis is at distance q * scale + base.
struct GridAxis {
    vec3 scale; ///< for bytes 0 and 3, 1 and 2 of a word: 1, 2^-8 and 2^-16 times the scale
    float base;
};

const vec3 BYTE_SCALES = vec3(1.0, 1.0 / 256.0, 1.0 / 65536.0);

/// word: originAndExponent of a NodeRecord.
GridAxis gridAxis(uint word, float rayOrigin, float inverse) {
    const float origin = uintBitsToFloat(word & 0xFFFFFF00u);
    precise float base = (origin - rayOrigin) * inverse;
    precise float scale = uintBitsToFloat((word & 0xFFu) << 23u) * inverse;
    return GridAxis(scale * BYTE_SCALES, base);
}

GridAxis movedBy(GridAxis g, float distance) {
    precise float base = g.base + distance;
    return GridAxis(g.scale, base);
}

// The bytes of a word as floats, times 1, 2^8, 2^16 and 1: BYTE_SCALES undoes it, and a mask is
// cheaper than a shift and a mask. Signed: docs/theory/kernel.md, "Arithmetic".
#define BYTES_AS_FLOATS(w)                                                                         \
    vec4(float(int((w)&0xFFu)), float(int((w)&0xFF00u)), float(int((w)&0xFF0000u)),                \
         float(int((w) >> 24u)))

#include "robust/box_slack.glsl"

/// Distances of four planes as bit patterns. As integers, patterns of floats that are not
/// negative compare as the floats do, and a negative one is below them all, which is all that is
/// needed here (docs/theory/kernel.md, "Arithmetic").
ivec4 planeDistances(uint word, GridAxis g) {
    precise vec4 t = BYTES_AS_FLOATS(word) * g.scale.xyzx + g.base;
    return floatBitsToInt(t);
}

/// The planes at which a ray enters a box, and those at which it leaves it; the same but for boxSlack().
struct GridAxes {
    GridAxis x, y, z;
};

/// Which of four children the ray enters within [tMin, tMax]: the `bits` of those.
uint enterFour(uvec3 nearWords, uvec3 farWords, GridAxes near, GridAxes far, float tMin, float tMax, uvec4 bits) {
    const ivec4 nx = planeDistances(nearWords.x, near.x), fx = planeDistances(farWords.x, far.x);
    const ivec4 ny = planeDistances(nearWords.y, near.y), fy = planeDistances(farWords.y, far.y);
    const ivec4 nz = planeDistances(nearWords.z, near.z), fz = planeDistances(farWords.z, far.z);
    const ivec4 enter = max(max(nx, ny), max(nz, ivec4(floatBitsToInt(tMin))));
    const ivec4 last = min(min(fx, fy), min(fz, ivec4(floatBitsToInt(tMax))));
    precise vec4 widened = intBitsToFloat(last) * BOX_SLACK;
    const ivec4 leave = floatBitsToInt(widened);
    return (enter.x <= leave.x ? bits.x : 0u) | (enter.y <= leave.y ? bits.y : 0u) |
           (enter.z <= leave.z ? bits.z : 0u) | (enter.w <= leave.w ? bits.w : 0u);
}

/// Which children of a node the ray enters within [tMin, tMax], tMin >= 0: bit (slot ^ octant) for each slot.
/// Conservative: never misses a box it touches, nor one that holds a primitive at tMin or tMax.
/// Rounding is covered by the margin of the boxes (BOX_MARGIN) where it is relative to the node's
/// size, and by the slack of the far planes where it is relative to the distance (after Ize 2013);
/// docs/theory/numerics.md derives both. Planes are near or far by the direction's sign: sorting
/// their distances would turn the inverted box of an absent child into a huge one.
uint enterChildren(Record r, Ray ray, float tMin, float tMax) {
    const vec3 origin = boxOrigin(ray), slack = boxSlack(ray);
    const GridAxes axes = GridAxes(gridAxis(r.r0.x, origin.x, ray.inverse.x),
                                   gridAxis(r.r0.y, origin.y, ray.inverse.y),
                                   gridAxis(r.r0.z, origin.z, ray.inverse.z));
    GridAxes near = axes, far = axes;
    if (HAS_PLACEMENTS) {
        near = GridAxes(movedBy(axes.x, -slack.x), movedBy(axes.y, -slack.y), movedBy(axes.z, -slack.z));
        far = GridAxes(movedBy(axes.x, slack.x), movedBy(axes.y, slack.y), movedBy(axes.z, slack.z));
    }
    // Rows hold low (xy) and high planes (zw) of the eight children.
    const uvec4 wx = ray.ascends[0] ? r.r1 : r.r1.zwxy;
    const uvec4 wy = ray.ascends[1] ? r.r2 : r.r2.zwxy;
    const uvec4 wz = ray.ascends[2] ? r.r3 : r.r3.zwxy;
    return enterFour(uvec3(wx.x, wy.x, wz.x), uvec3(wx.z, wy.z, wz.z), near, far, tMin, tMax,
                     ray.childBits[0]) |
           enterFour(uvec3(wx.y, wy.y, wz.y), uvec3(wx.w, wy.w, wz.w), near, far, tMin, tMax,
                     ray.childBits[1]);
}

#include "robust/triangle.glsl"

/// Nearest t in (tMin, tMax) at which the ray meets the sphere, or INFINITE_DISTANCE. The
/// discriminant comes from the distance of the line to the centre, not from b^2 - 4ac, which
/// has no correct digit left once the sphere is 4096 radii away. The perpendicular is found in two
/// steps: after the first, rounding leaves a part along the line of some 2^-22 of the distance.
/// The root that would cancel comes from the product of the roots.
float hitSphere(vec3 center, float radius, Ray ray, float tMin, float tMax) {
    const vec3 f = ray.origin - center;
    const float nearlyClosest = -dot(f, ray.direction) * ray.inverseLength2;
    const vec3 nearlyPerpendicular = f + nearlyClosest * ray.direction;
    const float correction = -dot(nearlyPerpendicular, ray.direction) * ray.inverseLength2;
    const float closest = nearlyClosest + correction;
    const float distance = length(nearlyPerpendicular + correction * ray.direction);
    const float discriminant = (radius - distance) * (radius + distance) * ray.inverseLength2;
    const float s = sqrt(max(discriminant, 0.0));
    const float q = closest + (closest >= 0.0 ? s : -s);
    const float fromOrigin = length(f);
    const float product = (fromOrigin - radius) * (fromOrigin + radius) * ray.inverseLength2;
    const float other = q != 0.0 ? product / q : INFINITE_DISTANCE;
    const float t0 = min(q, other), t1 = max(q, other);
    const float t = t0 > tMin ? t0 : t1;
    return discriminant >= 0.0 && t > tMin && t < tMax ? t : INFINITE_DISTANCE;
}
