// Warps of [0,1)^2 into the directions and points that samplers share.

/// Uniform on the unit disk. Polar map, area measure.
vec2 sampleDisk(vec2 u) {
    return sqrt(u.x) * cosSin(4.0 * u.y);
}

/// Hemisphere about +z, pdf cos / pi in solid angle (Malley's method).
vec3 sampleCosineHemisphere(vec2 u) {
    const vec2 d = sampleDisk(u);
    return vec3(d, sqrt(max(1.0 - u.x, 0.0)));
}

/// All directions, pdf 1 / (4 pi) in solid angle.
vec3 sampleUniformSphere(vec2 u) {
    const float z = 1.0 - 2.0 * u.x;
    return vec3(2.0 * sqrt(max(u.x * (1.0 - u.x), 0.0)) * cosSin(4.0 * u.y), z);
}

/// Hemisphere about +z, pdf 1 / (2 pi) in solid angle.
vec3 sampleUniformHemisphere(vec2 u) {
    return vec3(sqrt(max(1.0 - u.x * u.x, 0.0)) * cosSin(4.0 * u.y), u.x);
}
