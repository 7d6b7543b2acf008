// The base under an interface: diffuse reflection, with what the interface lets through and sends back. The interface
// is a plane or of microfacets. docs/theory/surfaces.md, "Plastic", has the formulas.

/// The share of light along w that an interface of microfacets lets through (host/kernel/material_rows.hpp).
float facetTransmittance(uint table, float cosine) {
    const float place = sqrt(clamp(cosine, 0.0, 1.0)) * float(TRANSMITTANCE_PIECES);
    const float piece = min(floor(place), float(TRANSMITTANCE_PIECES - 1u)), x = place - piece;
    const vec4 c = uintBitsToFloat(ROW(materialRows, table + uint(int(piece))));
    return clamp(c.x + x * (c.y + x * (c.z + x * c.w)), 0.0, 1.0);
}

/// The share of light at this cosine, from outside, that the interface of a material lets through.
float throughInterface(Material m, StatedParameters p, float cosine) {
    float cosTransmitted, plane = 0.0, facets = 0.0;
    if (sceneHas(INTERFACE_IS_SMOOTH))
        plane = 1.0 - fresnelDielectric(clamp(cosine, 0.0, 1.0), 1.0 / p.index[INDEX_RATIO], cosTransmitted);
    if (HAS_FACETS) facets = facetTransmittance(hasClosure(m, CLOSURE_LAYERS) ? p.table : 0u, cosine);
    return hasClosure(m, INTERFACE_IS_SMOOTH) ? plane : facets;
}

/// What the base reflects, over pi, of the light that the interface lets through, over the transmittances of both
/// directions: all orders of reflection between base and interface.
vec3 albedoUnderInterface(Material m, StatedParameters p) {
    const float ratio = p.index[INDEX_RATIO];
    const vec3 back = p.index[INDEX_BACK] * (hasClosure(m, BASE_IS_NONLINEAR) ? p.color : vec3(1.0));
    return p.color / ((1.0 - back) * (ratio * ratio));
}

/// What the base sends on towards wi, of what it would without an interface.
float statedDiffuse(Material m, StatedParameters p, vec3 wi) {
    if (!sceneHas(CLOSURE_LAYERS)) return 1.0;
    const float through = throughInterface(m, p, abs(wi.z));
    return hasClosure(m, CLOSURE_LAYERS) ? through : 1.0;
}
