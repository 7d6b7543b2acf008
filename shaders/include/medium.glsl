// What absorbs along a path: the inside of the surface that it has entered last. Entering a volume sets it
// and leaving one clears it (docs/theory/estimator.md, "Volumes"). Scenes without absorption have nothing of this.

const bool HAS_ABSORPTION = (CLOSURES & (VOLUME_ABSORBS)) != 0u;

/// No material begins there.
const uint NO_MEDIUM = 0xFFFFFFFFu;

/// Where light comes from that leaves s: `here`, or what is beyond s.
uint mediumBeyond(SurfacePoint s, Material m, uint here, bool transmitted) {
    if (!HAS_ABSORPTION || !transmitted || !boundsVolume(m)) return here;
    return s.outside ? s.material : NO_MEDIUM;
}

/// The share of light that is left after that distance in a medium (Beer and Lambert).
vec3 transmittance(uint medium, float distance) {
    if (!HAS_ABSORPTION) return vec3(1.0);
    const bool none = medium == NO_MEDIUM;
    const vec3 absorption =
        uintBitsToFloat(ROW(materialRows, none ? 0u : medium + PRINCIPLED_ABSORPTION_ROW).xyz);
    return none ? vec3(1.0) : exp(-absorption * distance);
}
