/// How far a point whose error is at most `error` per component has to move along the unit normal n for the
/// exact surface to lie behind it (pbrt 4, section 6.8.6).
float offsetLength(float error, vec3 n) { return error * dot(abs(n), vec3(1.0)); }
