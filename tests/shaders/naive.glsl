// Negative controls: what the shipped intersection tests must be better than.

/// Moeller and Trumbore 1997 with an absolute cut-off for the determinant, as common code has it.
float hitTriangleNaively(vec3 v0, vec3 v1, vec3 v2, Ray ray) {
    const vec3 e1 = v1 - v0, e2 = v2 - v0, p = cross(ray.direction, e2);
    const float determinant = dot(e1, p);
    if (abs(determinant) < 1e-8) return INFINITE_DISTANCE;
    const vec3 s = ray.origin - v0, q = cross(s, e1);
    const float u = dot(s, p) / determinant, v = dot(ray.direction, q) / determinant;
    const float t = dot(e2, q) / determinant;
    return u >= 0.0 && v >= 0.0 && u + v <= 1.0 ? t : INFINITE_DISTANCE;
}

/// The textbook quadratic.
float hitSphereNaively(vec3 center, float radius, Ray ray, float tMin, float tMax) {
    const vec3 f = ray.origin - center;
    const float a = dot(ray.direction, ray.direction), b = 2.0 * dot(f, ray.direction);
    const float c = dot(f, f) - radius * radius, discriminant = b * b - 4.0 * a * c;
    if (discriminant < 0.0) return INFINITE_DISTANCE;
    const float root = sqrt(discriminant);
    const float t0 = (-b - root) / (2.0 * a), t1 = (-b + root) / (2.0 * a);
    const float t = t0 > tMin ? t0 : t1;
    return t > tMin && t < tMax ? t : INFINITE_DISTANCE;
}

/// The slab test without slack.
float enterBoxNaively(vec3 low, vec3 high, Ray ray, float tMax) {
    const vec3 inverse = 1.0 / ray.direction;
    const vec3 a = (low - ray.origin) * inverse, b = (high - ray.origin) * inverse;
    const vec3 nearest = min(a, b), farthest = max(a, b);
    const float tNear = max(max(nearest.x, nearest.y), max(nearest.z, 0.0));
    const float tFar = min(min(farthest.x, farthest.y), min(farthest.z, tMax));
    return tNear <= tFar ? tNear : INFINITE_DISTANCE;
}
