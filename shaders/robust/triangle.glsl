// Ray against triangle: watertight (docs/theory/numerics.md, "Triangles").

struct TriangleHit {
    float t; ///< INFINITE_DISTANCE: no hit
    float b1, b2; ///< barycentric weights of v1 and v2
};

/// A point seen along the ray: z is its depth (times the direction's largest component), x and y
/// where it is when the ray is the z axis.
vec3 alongRay(vec3 v, Ray ray) {
    precise vec3 p = permute(v - ray.origin, ray);
    precise vec2 sheared = p.xy - ray.shear.xy * p.z;
    return vec3(sheared, p.z);
}

/// On which side of the edge from a to b the ray passes. The two products are rounded alike
/// whichever way round the edge is walked, and since rounding is monotonic, the difference of the
/// rounded products is never of the wrong sign, at worst zero. `precise` keeps them from being
/// fused.
float edgeFunction(vec3 a, vec3 b) {
    precise float e = a.x * b.y - a.y * b.x;
    return e;
}

/// u, v, w: the edge functions opposite to a, b and c. Zero counts as inside. All of one sign, that of their
/// sum: none of the weights is negative. Where all are zero weights are not numbers, which no comparison takes.
TriangleHit triangleHit(vec3 a, vec3 b, vec3 c, float u, float v, float w, Ray ray) {
    // Weights first: the product of an edge function and a distance may overflow.
    const float inverse = 1.0 / (u + v + w);
    const float b0 = u * inverse, b1 = v * inverse, b2 = w * inverse;
    const bool inside = b0 >= 0.0 && b1 >= 0.0 && b2 >= 0.0;
    const float t = (b0 * a.z + b1 * b.z + b2 * c.z) * ray.shear.z;
    return TriangleHit(inside ? t : INFINITE_DISTANCE, b1, b2);
}

struct TrianglePairHit {
    TriangleHit first, second;
};

/// Watertight test (Woop, Benthin and Wald 2013) of the triangles p0 p1 p2 and p0 p2 p3. A point
/// is mapped to the same bits in every triangle that shares it, and the edge functions of an edge
/// agree: no ray passes between two triangles.
TrianglePairHit hitTrianglePair(LeafPoints points, Ray ray) {
    const vec3 a = alongRay(points.p0, ray), b = alongRay(points.p1, ray);
    const vec3 c = alongRay(points.p2, ray), d = alongRay(points.p3, ray);
    const float shared_ = edgeFunction(a, c);
    return TrianglePairHit(
        triangleHit(a, b, c, edgeFunction(c, b), shared_, edgeFunction(b, a), ray),
        triangleHit(a, c, d, edgeFunction(d, c), edgeFunction(a, d), -shared_, ray));
}
