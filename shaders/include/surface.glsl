// What the path needs to know of the point it hit.

struct SurfacePoint {
    vec3 position; ///< on the flat triangle, or the sphere
    float error;   ///< bound of the position's error, per component
    vec3 geometric; ///< unit geometric normal, on the side of wo
    vec3 shading;   ///< unit; read through shadingNormal()
    vec3 wo;        ///< back along the ray; unit, as the rays of paths are
    bool outside;   ///< wo is on the side the stored geometric normal points to
    uint material;
    uint skipPrimitive; ///< planar primitives cannot be hit by rays that leave them
    float lift; ///< height of the smooth surface over `position`, along `geometric`; 0: flat
    uint primitive; ///< in the Primitive buffer, as its corners' attributes are numbered
    vec2 weights; ///< barycentric, of the second and third corner (triangles)
    vec4 tangent; ///< relief.glsl; with TANGENT_FRAMES
    vec3 coat;    ///< unit; the clear coat's normal, with sceneHasCoatNormals() (relief.glsl)
    uint placement; ///< that skipPrimitive is in; NO_PLACEMENT: none
    uint mixture;   ///< first row of the mixture that `material` is of and that is evaluated together; NO_MIXTURE
    uint table;     ///< by which light samples choose tiles of the environment (guide.glsl)
};

/// No material begins there.
const uint NO_MIXTURE = 0xFFFFFFFFu;

/// Without normals of corners a second copy of the geometric one, which would be carried along.
vec3 shadingNormal(SurfacePoint s) { return HAS_NORMALS ? s.shading : s.geometric; }

/// The frame that a BSDF is evaluated in; z is the shading normal, x and y the surface's tangent and bitangent where
/// it has them and they matter.
ShadingFrame shadingFrame(SurfacePoint s) {
    const vec3 n = shadingNormal(s);
    if (TANGENT_FRAMES && s.tangent.w != 0.0)
        return ShadingFrame(s.tangent.xyz, s.tangent.w * cross(n, s.tangent.xyz), n);
    return makeFrame(shadingNormal(s));
}

/// Octahedral to unit vector (Meyer et al. 2010).
vec3 decodeNormal(uint packed_) {
    const vec2 e = unpackSnorm2x16(packed_);
    vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    const float fold = max(-n.z, 0.0);
    n.xy += vec2(n.x >= 0.0 ? -fold : fold, n.y >= 0.0 ? -fold : fold);
    return unit(n);
}

/// What a placement does to what lies in it; nothing for NO_PLACEMENT.
struct Placing {
    bool isPlaced;
    bool mirrors;
    PlacementRecord record;
    TransformRecord transform;
};

Placing placingOf(uint placement) {
    Placing p;
    p.isPlaced = HAS_PLACEMENTS && placement != NO_PLACEMENT;
    p.record = fetchPlacement(placement);
    p.transform = fetchTransform(p.isPlaced ? p.record.transform : 0u);
    p.mirrors = p.isPlaced && (p.record.placement & PLACEMENT_MIRRORS) != 0u;
    return p;
}

vec3 pointInWorld(Placing p, vec3 v) {
    return p.isPlaced ? placed(p.transform.toWorld0, p.transform.toWorld1, p.transform.toWorld2, v) : v;
}

/// The primitive with its corners in the world.
PlacedPrimitive inWorld(Placing p, PlacedPrimitive at) {
    at.v0 = pointInWorld(p, at.v0);
    at.v1 = pointInWorld(p, at.v1);
    at.v2 = pointInWorld(p, at.v2);
    return at;
}

/// The unit normal in the world, by the inverse transpose of the placement.
vec3 normalInWorld(Placing p, vec3 n) {
    return p.isPlaced ? unit(n.x * p.record.toPrototype0.xyz + n.y * p.record.toPrototype1.xyz +
                             n.z * p.record.toPrototype2.xyz)
                      : n;
}

/// The unit tangent in the world; zero where it has no length there.
vec3 tangentInWorld(Placing p, vec3 t) {
    if (!p.isPlaced) return t;
    const vec3 v = turned(p.transform.toWorld0, p.transform.toWorld1, p.transform.toWorld2, t);
    const float length2 = dot(v, v);
    return length2 > 0.0 ? v * inversesqrt(length2) : vec3(0.0);
}

/// Unit geometric normal.
vec3 triangleNormal(Primitive p, PlacedPrimitive at) {
    const vec3 stored = uintBitsToFloat(uvec3(p.n0, p.n1, p.n2));
    return isSmooth(p) ? planeNormal(at.v1 - at.v0, at.v2 - at.v0) : stored;
}

/// The normals of the corners of a triangle that has some, as the file means them.
struct CornerNormals {
    vec3 n0, n1, n2;
};

CornerNormals inWorld(Placing p, CornerNormals n) {
    return CornerNormals(normalInWorld(p, n.n0), normalInWorld(p, n.n1), normalInWorld(p, n.n2));
}

/// The interpolated normal, or the geometric one where opposite normals cancel and there is no better
/// direction.
vec3 interpolatedNormal(CornerNormals n, vec3 b, vec3 geometric) {
    const vec3 sum = b.x * n.n0 + b.y * n.n1 + b.z * n.n2;
    const float length2 = dot(sum, sum);
    return length2 > 0.0 ? sum * inversesqrt(length2) : geometric;
}

#include "robust/terminator_offset.glsl"

CornerNormals cornerNormals(Primitive p) {
    return CornerNormals(decodeNormal(p.n0), decodeNormal(p.n1), decodeNormal(p.n2));
}

/// Fills in what depends on the normals of the corners. b: barycentric weights.
void smoothShading(inout SurfacePoint s, bool given, CornerNormals n, PlacedPrimitive at, vec3 b) {
    if (!HAS_CORNER_NORMALS) return;
    if (given) s.shading = interpolatedNormal(n, b, s.geometric);
    if (given && FACES_FORWARD && !FLAT_TERMINATOR)
        s.lift = liftAt(n, at, b, s.outside ? s.geometric : -s.geometric);
}

/// Fills in the point of the hit that `t` found. `shading` is left as the scene states it; see
/// faceForward.
SurfacePoint surfaceAt(Traversal t) {
    SurfacePoint s;
    PlacedPrimitive place = fetchPlace(t.hitPrimitive);
    const Primitive p = fetchPrimitive(place.primitive);
    CornerNormals normals = cornerNormals(p);
    s.placement = t.hitPlacement;
    const Placing placing = placingOf(t.hitPlacement);
    if (HAS_PLACEMENTS) {
        place = inWorld(placing, place);
        normals = inWorld(placing, normals);
    }
    const vec3 v0 = place.v0, v1 = place.v1, v2 = place.v2;
    s.material = materialOf(p);
    s.mixture = NO_MIXTURE;
    s.wo = -t.direction;
    s.lift = 0.0;
    if (HAS_TRIANGLES && !place.isSphere) {
        const float b0 = 1.0 - t.b1 - t.b2;
        s.position = b0 * v0 + t.b1 * v1 + t.b2 * v2;
        s.error = interpolationError(abs(b0 * v0) + abs(t.b1 * v1) + abs(t.b2 * v2));
        s.geometric = triangleNormal(p, place);
        // Rounded corners, not the normal of the prototype: rays start on the side of the triangle that they meet.
        if (HAS_PLACEMENTS && placing.isPlaced)
            s.geometric = (placing.mirrors ? -1.0 : 1.0) * planeNormal(v1 - v0, v2 - v0);
        s.skipPrimitive = t.hitPrimitive;
    }
    if (HAS_SPHERES && place.isSphere) {
        const vec3 along = t.origin + t.tMax * t.direction - v0;
        s.geometric = unit(along);
        s.position = v0 + place.radius * s.geometric;
        s.error = sphereError(v0, place.radius);
        s.skipPrimitive = NO_PRIMITIVE;
    }
    s.shading = s.geometric;
    s.outside = dot(s.geometric, s.wo) >= 0.0;
    s.primitive = place.primitive;
    s.weights = vec2(t.b1, t.b2);
    s.tangent = vec4(0.0);
    if (HAS_TRIANGLES && !place.isSphere)
        smoothShading(s, isSmooth(p), normals, place, vec3(1.0 - t.b1 - t.b2, t.b1, t.b2));
    return s;
}

/// Whether a surface, its normals as stored, is seen from where its shading normals do not point.
bool isSeenFromBehind(SurfacePoint s) { return s.outside == (dot(s.geometric, shadingNormal(s)) < 0.0); }

/// Two-sided shading: both normals on the side of wo.
void faceForward(inout SurfacePoint s) {
    if (!FACES_FORWARD) return;
    if (!s.outside) s.geometric = -s.geometric;
    if (!HAS_CORNER_NORMALS) {
        s.shading = s.geometric;
        return;
    }
    if (dot(s.shading, s.geometric) < 0.0) s.shading = -s.shading;
    if (dot(s.shading, s.wo) <= 0.0) s.shading = s.geometric;
}

/// The shading normal that a surface, faced forward, had before maps turned it.
vec3 unmappedNormal(SurfacePoint s) {
    if (s.skipPrimitive == NO_PRIMITIVE) return s.geometric;
    const Primitive p = fetchPrimitive(fetchPlace(s.skipPrimitive).primitive);
    if (!isSmooth(p)) return s.geometric;
    CornerNormals n = cornerNormals(p);
    if (HAS_PLACEMENTS) n = inWorld(placingOf(s.placement), n);
    const vec3 b = vec3(1.0 - s.weights.x - s.weights.y, s.weights);
    const vec3 stated = interpolatedNormal(n, b, s.geometric);
    if (!FACES_FORWARD) return stated;
    const vec3 facing = dot(stated, s.geometric) < 0.0 ? -stated : stated;
    return dot(facing, s.wo) <= 0.0 ? s.geometric : facing;
}

/// Whether light can be reflected towards w. A smooth surface ends at the horizon of its shading
/// normal; the triangle under it is then but one of the things that may be in the way.
bool isReflected(SurfacePoint s, vec3 w) { return HAS_CORNER_NORMALS && s.lift > 0.0 || dot(s.geometric, w) > 0.0; }

/// The point that light is reflected from.
vec3 litPoint(SurfacePoint s) {
    return HAS_CORNER_NORMALS && FACES_FORWARD ? s.position + s.lift * s.geometric : s.position;
}

/// Where a ray starts that leaves s towards w: on the side of wo, or, transmitted, on the other one.
/// Refracted light leaves from the triangle itself, which lies in its way otherwise. Where
/// normals stay as they are stored, light leaves on either side whatever the material.
vec3 leave(SurfacePoint s, vec3 w, bool transmitted) {
    if (!FACES_FORWARD) return offsetOrigin(s.position, s.error, s.geometric, w);
    const vec3 from = transmitted ? s.position : litPoint(s);
    const vec3 lift = offsetLength(s.error, s.geometric) * s.geometric;
    return transmitted ? from - lift : from + lift;
}

/// What that ray cannot hit: the plane it starts on. From above it can.
uint skipOnLeaving(SurfacePoint s, bool transmitted) {
    return HAS_CORNER_NORMALS && !transmitted && s.lift > 0.0 ? NO_PRIMITIVE : s.skipPrimitive;
}
