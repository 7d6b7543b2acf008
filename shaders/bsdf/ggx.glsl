// GGX microfacets (Trowbridge and Reitz 1975; Walter et al. 2007), stretched along x and y, with Smith's
// height-correlated masking and shadowing (Heitz 2014). Normals are sampled as they are seen from wo.
// Everything is in the terms of the view's stretched length, |(alpha w.xy, w.z)|, of which no part is a
// difference of nearly equal numbers, neither for narrow lobes nor at grazing views. Directions are unit
// vectors in the frame of the shading normal.

/// Per steradian; its integral times cos is 1.
float ggxD(vec3 h, vec2 alpha) {
    const vec2 slope = h.xy / alpha;
    const float q = dot(slope, slope) + h.z * h.z;
    return 1.0 / (PI * alpha.x * alpha.y * q * q);
}

float stretchedLength(vec3 w, vec2 alpha) { return length(vec3(alpha * w.xy, w.z)); }

/// Masking and shadowing over 4 |cos wo| |cos wi|: G2 = 1 / (1 + Lambda(wo) + Lambda(wi)) with
/// Lambda(w) = (stretched length / |cos w| - 1) / 2.
float ggxVisibility(vec3 wo, vec3 wi, vec2 alpha) {
    return 0.5 / (abs(wi.z) * stretchedLength(wo, alpha) + abs(wo.z) * stretchedLength(wi, alpha));
}

/// Density of the normals seen from wo, over |wo . h|: D(h) G1(wo) / cos wo. wo.z > 0.
float visibleNormals(vec3 wo, vec3 h, vec2 alpha) {
    return 2.0 * ggxD(h, alpha) / (wo.z + stretchedLength(wo, alpha));
}

/// A normal seen from wo (Dupuy and Benyoub, "Sampling Visible GGX Normals with Spherical Caps", 2023):
/// in the space where the surface is a hemisphere, mirrored directions are uniform on a cap.
vec3 sampleVisibleNormal(vec3 wo, vec2 alpha, vec2 u) {
    const vec3 v = unit(vec3(alpha * wo.xy, wo.z));
    const float cap = 1.0 + v.z, fromTop = u.x * cap; // 1 - z
    const float sine = sqrt(max(fromTop * (2.0 - fromTop), 0.0));
    const vec3 h = vec3(sine * cosSin(4.0 * u.y), 1.0 - fromTop) + v;
    return unit(vec3(alpha * h.xy, max(h.z, TINY)));
}
