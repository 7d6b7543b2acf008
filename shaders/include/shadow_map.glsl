// A shadow map of a sun: of each cell of a plane across its direction, up to which height over that plane no place is lit, for
// certain (docs/theory/estimator.md, "Shadow map"). The ray of a light sample from there would meet a surface: it need not be
// traced. host/kernel/cast_shadows.hpp makes the map.

ShadowMap shadowMapOf(const Frame frame) {
    return ShadowMap(frame.shadowAcross, frame.shadowAlong, frame.shadowTowards, frame.shadowMap);
}

/// Whether the ray of a light sample is stopped for certain. direction: unit, to what is infinitely far.
bool isInShadow(const ShadowMap map, vec3 origin, vec3 direction) {
    const float x = atPoint(map.across, origin), y = atPoint(map.along, origin);
    // Ordered comparisons, which are false for NaN.
    const bool isWithin = min(x, y) >= 0.0 && max(x, y) < float(SHADOW_MAP_SIDE);
    const uint cell = isWithin ? uint(y) * SHADOW_MAP_SIDE + uint(x) : 0u;
    const float dark = uintBitsToFloat(componentOf(ROW(guideRows, map.firstRow + (cell >> 2u)), cell & 3u));
    return isWithin && direction == map.towards && dot(map.towards, origin) < dark;
}
