// Guided light samples (docs/theory/estimator.md, "Learned light samples"): the cell that a point is in
// (shared/guide_types.h).

/// A table of the environment's tiles, by its first row: in the guide, or, where there is none, the environment's own.
const uint OWN_TABLE = 0u;

float guideCoordinate(uint axis, vec3 p, vec3 n) {
    const vec3 v = axis < 3u ? p : n;
    const uint i = axis < 3u ? axis : axis - 3u;
    return i == 0u ? v.x : (i == 1u ? v.y : v.z);
}

/// The table of the cell that a surface, from the side where light leaves, or a point in a medium, is in.
uint guideTable(SurfacePoint lit) {
    if (!GUIDES_LIGHT) return OWN_TABLE;
    const vec3 p = litPoint(lit), n = shadingNormal(lit);
    uint node = 0u;
    for (uint level = 0u; level < GUIDE_LEVELS; ++level) {
        const uvec4 r = ROW(guideRows, node);
        const bool above = guideCoordinate(r.w & 0xFFu, p, n) > uintBitsToFloat(r.x);
        const uint axis = (above ? r.w >> 16u : r.w >> 8u) & 0xFFu;
        const bool second = guideCoordinate(axis, p, n) > uintBitsToFloat(above ? r.z : r.y);
        node = 4u * node + 1u + (above ? 2u : 0u) + (second ? 1u : 0u);
    }
    return GUIDE_NODES + (node - GUIDE_NODES) * GUIDE_TABLE_ROWS;
}
