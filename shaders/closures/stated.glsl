// Materials whose closures are stated: a diffuse base, an interface, or a base under an interface.

/// The base and the interface as wo sees them.
void stateClosures(inout Closures c, Material m, StatedParameters p, Incidence i) {
    const bool hasBase = hasClosure(m, CLOSURE_BASE);
    c.isSmooth = hasClosure(m, INTERFACE_IS_SMOOTH);
    c.isThin = hasClosure(m, INTERFACE_IS_THIN);
    const float ratio = p.index[INDEX_RATIO];
    c.eta = i.entering || c.isThin || hasBase ? 1.0 / ratio : ratio; // an opaque base has no inside
    const bool isRefracting = hasClosure(m, INTERFACE_IS_DIELECTRIC) && !hasBase;
    const float least = max(LEAST_GGX_ALPHA, isRefracting ? p.index[INDEX_LEAST_ALPHA] : 0.0);
    c.facets = facetShape(max(vec2(p.alphaX, p.alphaY), vec2(least)), m.header.w);
    c.diffuse = p.color;
    c.diffuseShare = hasBase ? 1.0 : 0.0;
    if (sceneHas(CLOSURE_LAYERS) && hasClosure(m, CLOSURE_LAYERS)) {
        // By what the interface reflects towards wo and by the colours of both.
        const float through = throughInterface(m, p, i.wo.z);
        const float top = (1.0 - through) * mean(p.edge), base = through * mean(p.color);
        c.diffuse = through * albedoUnderInterface(m, p);
        c.diffuseShare = top > 0.0 ? base / (top + base) : 1.0;
    }
}

/// What the base sends on towards wi, of what it would without an interface.
float statedDiffuse(Material m, StatedParameters p, vec3 wi) {
    if (!sceneHas(CLOSURE_LAYERS)) return 1.0;
    const float through = throughInterface(m, p, abs(wi.z));
    return hasClosure(m, CLOSURE_LAYERS) ? through : 1.0;
}

/// exact: reflectance of a dielectric by Fresnel's equations; cosTransmitted: of the same. cosine: between direction
/// and facet; cosI: between the normal and wi, which another convention has in its place.
InterfaceLight statedLight(Material m, StatedParameters p, Closures c, float cosine, float cosI, float exact,
                           float cosTransmitted) {
    InterfaceLight f = InterfaceLight(p.color, vec3(0.0), cosTransmitted, 1.0);
    const bool transmits = hasClosure(m, INTERFACE_REFRACTS) || c.isThin;
    if (hasClosure(m, INTERFACE_IS_DIELECTRIC)) {
        float share = exact;
        if (!EXACT_FRESNEL && c.isSmooth && cosTransmitted > 0.0 && transmits)
            share = schlickFresnel(cosine, p.index[INDEX_RATIO]);
        // A sheet, with all that is reflected between its sides: R + (1 - R)^2 R / (1 - R^2).
        if (c.isThin) share = 2.0 * exact / (1.0 + exact);
        if (hasClosure(m, INTERFACE_IS_IDEAL)) share = cosTransmitted > 0.0 ? 0.0 : 1.0;
        f.reflected = hasClosure(m, INTERFACE_IS_IDEAL) ? vec3(0.0) : share * p.edge;
        f.transmitted = transmits ? (1.0 - share) * p.color : vec3(0.0);
    }
    if (hasClosure(m, INTERFACE_IS_CONDUCTOR))
        f.reflected = p.color * (EXACT_FRESNEL ? fresnelConductor(cosine, p.edge, p.index)
                                               : approximateFresnelConductor(abs(cosI), p.edge, p.index));
    return f;
}
