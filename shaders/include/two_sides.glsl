// Surfaces that scatter light through them into many directions (rough glass) are lit from both sides. A
// light sample there goes to one of them, each in one of two cases, and counts only if it comes from that
// side: its density is half of what it would be. Scenes without such surfaces have nothing of this.

const bool SCATTERS_THROUGH = (CLOSURES & (LOBE_GLOSSY_TRANSMISSION | LOBE_DIFFUSE_TRANSMISSION)) != 0u;

bool isLitFromBothSides(uint lobes) {
    return SCATTERS_THROUGH && (lobes & TRANSMISSION_LOBES & ~DELTA_LOBES) != 0u;
}

bool isBehind(SurfacePoint s, vec3 w) { return SCATTERS_THROUGH && dot(shadingNormal(s), w) < 0.0; }

/// The surface as its other side sees it; light leaves that side from the flat triangle.
SurfacePoint otherSide(SurfacePoint s) {
    s.geometric = -s.geometric;
    s.shading = -s.shading;
    s.lift = 0.0;
    s.wo = -s.wo;
    s.table = guideTable(s);
    return s;
}

/// The side of a surface of material m from which light comes that is transmitted, or not.
SurfacePoint sideLit(SurfacePoint s, Material m, bool transmitted) {
    if (isLitFromBothSides(lobesOf(m)) && transmitted) return otherSide(s);
    return s;
}

/// The side that a light sample with the numbers u goes to; leaves numbers in [0, 1) that are uniform
/// again, multiples of 2^-24: the digit that the choice takes from the first is filled from a hash.
bool takesOtherSide(inout vec2 u) {
    const bool other = u.x >= 0.5;
    const uint digit = pcg4d(uvec4(floatBitsToUint(u), 0u, 0u)).x >> 31u;
    u.x = (other ? 2.0 * u.x - 1.0 : 2.0 * u.x) + float(int(digit)) * (1.0 / 16777216.0);
    return other;
}
