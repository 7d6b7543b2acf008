// In the place of shaders/robust/triangle.glsl: what most ray tracers do. Moeller and Trumbore 1997; not
// watertight, and a triangle with edges below 1e-4 is lost by the cut-off.

struct TriangleHit {
    float t; ///< INFINITE_DISTANCE: no hit
    float b1, b2; ///< barycentric weights of v1 and v2
};

struct TrianglePairHit {
    TriangleHit first, second;
};

/// Both triangles share the corner p0 and the edge to p2, and what follows from them.
TrianglePairHit hitTrianglePair(LeafPoints points, Ray ray) {
    const vec3 e1 = points.p1 - points.p0, e2 = points.p2 - points.p0, e3 = points.p3 - points.p0;
    const vec3 s = ray.origin - points.p0;
    const vec3 p = cross(ray.direction, e2);
    const float sp = dot(s, p);
    const float determinant1 = dot(e1, p), determinant3 = dot(e3, p);
    const float inverse1 = 1.0 / determinant1, inverse3 = 1.0 / determinant3;
    const vec3 q1 = cross(s, e1), q3 = cross(s, e3);
    const float u1 = sp * inverse1, v1 = dot(ray.direction, q1) * inverse1;
    const float u3 = sp * inverse3, v3 = dot(ray.direction, q3) * inverse3;
    const bool in1 =
        abs(determinant1) > 1e-8 && u1 >= 0.0 && v1 >= 0.0 && u1 + v1 <= 1.0;
    const bool in3 =
        abs(determinant3) > 1e-8 && u3 >= 0.0 && v3 >= 0.0 && u3 + v3 <= 1.0;
    return TrianglePairHit(
        TriangleHit(in1 ? dot(e2, q1) * inverse1 : INFINITE_DISTANCE, u1, v1),
        TriangleHit(in3 ? dot(e2, q3) * inverse3 : INFINITE_DISTANCE, v3, u3));
}
