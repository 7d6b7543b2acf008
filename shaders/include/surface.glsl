// What the path needs to know of the point it hit.

struct SurfacePoint {
    vec3 position;
    vec3 error;     ///< bound of the position's error, per component
    vec3 geometric; ///< unit geometric normal, on the side of wo
    vec3 shading;   ///< unit shading normal
    vec3 wo;        ///< unit, back along the ray
    bool outside;   ///< wo is on the side the stored geometric normal points to
    uint material;
    uint skipPrimitive; ///< planar primitives cannot be hit by rays that leave them
};

/// Octahedral to unit vector (Meyer et al. 2010).
vec3 decodeNormal(uint packed_) {
    const vec2 e = unpackSnorm2x16(packed_);
    vec3 n = vec3(e, 1.0 - abs(e.x) - abs(e.y));
    const float fold = max(-n.z, 0.0);
    n.xy += vec2(n.x >= 0.0 ? -fold : fold, n.y >= 0.0 ? -fold : fold);
    return normalize(n);
}

/// The interpolated normal as the file means it, or the geometric one where there is none.
vec3 interpolatedNormal(Primitive p, float b1, float b2, vec3 geometric) {
    if (!HAS_NORMALS) return geometric;
    const NormalTriple normals = fetchNormals(p.normals == NO_NORMALS ? 0u : p.normals);
    const vec3 n = (1.0 - b1 - b2) * decodeNormal(normals.n0) + b1 * decodeNormal(normals.n1) +
                   b2 * decodeNormal(normals.n2);
    const float length2 = dot(n, n);
    // Opposite corner normals may cancel: no direction is better than the geometric one then.
    return p.normals != NO_NORMALS && length2 > 0.0 ? n * inversesqrt(length2) : geometric;
}

/// Fills in the point of the hit that `t` found. `shading` is left as the scene states it; see
/// faceForward.
SurfacePoint surfaceAt(Traversal t) {
    SurfacePoint s;
    const Primitive p = fetchPrimitive(t.hitPrimitive);
    s.material = p.material;
    s.wo = -normalize(t.ray.direction);
    const bool isSphere = HAS_SPHERES && (!HAS_TRIANGLES || p.kind == PRIMITIVE_SPHERE);
    if (HAS_TRIANGLES && !isSphere) {
        const float b0 = 1.0 - t.b1 - t.b2;
        s.position = b0 * p.v0 + t.b1 * p.v1 + t.b2 * p.v2;
        s.error = interpolationError(abs(b0 * p.v0) + abs(t.b1 * p.v1) + abs(t.b2 * p.v2));
        s.geometric = planeNormal(p.v1 - p.v0, p.v2 - p.v0);
        s.shading = interpolatedNormal(p, t.b1, t.b2, s.geometric);
        s.skipPrimitive = t.hitPrimitive;
    }
    if (HAS_SPHERES && isSphere) {
        const vec3 along = t.ray.origin + t.tMax * t.ray.direction - p.v0;
        s.geometric = normalize(along);
        s.position = p.v0 + p.v1.x * s.geometric;
        s.error = vec3((16.0 * UNIT_ROUNDOFF) * p.v1.x) + (4.0 * UNIT_ROUNDOFF) * abs(p.v0);
        s.shading = s.geometric;
        s.skipPrimitive = NO_PRIMITIVE;
    }
    s.outside = dot(s.geometric, s.wo) >= 0.0;
    return s;
}

/// Two-sided shading: both normals on the side of wo. The CS184 renderer never flips one.
void faceForward(inout SurfacePoint s) {
    if (CS184) return;
    if (!s.outside) s.geometric = -s.geometric;
    if (dot(s.shading, s.geometric) < 0.0) s.shading = -s.shading;
    if (dot(s.shading, s.wo) <= 0.0) s.shading = s.geometric;
}

/// Where a ray that leaves s towards w starts.
vec3 leave(SurfacePoint s, vec3 w) { return offsetOrigin(s.position, s.error, s.geometric, w); }
