// Plastic: a diffuse base under the interface of a dielectric, with what the interface sends back to the base. The
// interface is smooth, or of microfacets. docs/estimator.md, "Plastic", has the formulas.

/// What the base sends through the interface, over the transmittances of both directions and the cosine.
vec3 baseUnderInterface(PlasticParameters p) {
    const bool isNonlinear = (p.flags & PLASTIC_IS_NONLINEAR) != 0u;
    const vec3 back = isNonlinear ? p.albedo * p.internalDiffuse : vec3(p.internalDiffuse);
    return p.albedo / ((1.0 - back) * (p.ior * p.ior) * PI);
}

/// Probability of the interface's lobe: of both lobes, by what the interface reflects towards wo and by their colours.
float interfaceShare(PlasticParameters p, float reflected) {
    const float top = reflected * mean(p.reflectance), base = (1.0 - reflected) * mean(p.albedo);
    return top > 0.0 ? top / (top + base) : 0.0;
}

/// u.x chooses the lobe, and what is left of it and u.y the direction in it.
vec2 leftInLobe(vec2 u, bool isTop, float share) {
    const float rest = isTop ? u.x / share : (u.x - share) / (1.0 - share);
    return vec2(clamp(rest, 0.0, 1.0 - UNIT_ROUNDOFF), u.y);
}

// --- Smooth --------------------------------------------------------------------------------------

float smoothReflectance(PlasticParameters p, float cosine) {
    float cosTransmitted;
    return fresnelDielectric(min(cosine, 1.0), 1.0 / p.ior, cosTransmitted);
}

/// Of the base alone: the interface's lobe is a delta lobe.
BsdfValue evaluatePlastic(PlasticParameters p, Incidence i, vec3 wi) {
    if (!(i.wo.z > 0.0 && wi.z > 0.0)) return NO_SCATTERING;
    const float atO = smoothReflectance(p, i.wo.z), atI = smoothReflectance(p, wi.z);
    return BsdfValue(baseUnderInterface(p) * ((1.0 - atO) * (1.0 - atI) * wi.z),
                     (1.0 - interfaceShare(p, atO)) * wi.z * INV_PI);
}

BsdfSample samplePlastic(PlasticParameters p, Incidence i, vec3 u) {
    if (!(i.wo.z > 0.0)) return ABSORBED;
    const float atO = smoothReflectance(p, i.wo.z), share = interfaceShare(p, atO);
    const bool isTop = u.x < share;
    if (isTop)
        return BsdfSample(vec3(-i.wo.xy, i.wo.z), p.reflectance * (atO / share), 0.0,
                          LOBE_DELTA_REFLECTION);
    const vec3 wi = sampleCosineHemisphere(leftInLobe(u.xy, false, share));
    const float pdf = (1.0 - share) * wi.z * INV_PI;
    const float through = (1.0 - atO) * (1.0 - smoothReflectance(p, wi.z));
    return BsdfSample(wi, baseUnderInterface(p) * (through * PI / (1.0 - share)), pdf,
                      LOBE_DIFFUSE_REFLECTION);
}

// --- Of microfacets ------------------------------------------------------------------------------

FacetShape facetsOf(PlasticParameters p) {
    return facetShape(vec2(p.alpha), p.flags);
}

/// The share of light along w that the interface lets through (host/kernel/interface_table.hpp).
float facetTransmittance(PlasticParameters p, float cosine) {
    const float place = sqrt(clamp(cosine, 0.0, 1.0)) * float(TRANSMITTANCE_PIECES);
    const float piece = min(floor(place), float(TRANSMITTANCE_PIECES - 1u)), x = place - piece;
    const vec4 c = uintBitsToFloat(ROW(materialRows, p.table + uint(int(piece))));
    return clamp(c.x + x * (c.y + x * (c.z + x * c.w)), 0.0, 1.0);
}

BsdfValue plasticOfFacets(PlasticParameters p, Incidence i, vec3 wi, float share, float through) {
    const vec3 h = unit(i.wo + wi);
    BsdfValue f = reflectionByFacets(facetsOf(p), i.wo, wi, h);
    f.value *= p.reflectance * smoothReflectance(p, dot(i.wo, h));
    f.value += baseUnderInterface(p) * (through * facetTransmittance(p, wi.z) * wi.z);
    f.pdf = share * f.pdf + (1.0 - share) * wi.z * INV_PI;
    return f;
}

BsdfValue evaluateFacetPlastic(PlasticParameters p, Incidence i, vec3 wi) {
    if (!(i.wo.z > 0.0 && wi.z > 0.0)) return NO_SCATTERING;
    const float through = facetTransmittance(p, i.wo.z);
    return plasticOfFacets(p, i, wi, interfaceShare(p, 1.0 - through), through);
}

BsdfSample sampleFacetPlastic(PlasticParameters p, Incidence i, vec3 u) {
    BsdfSample s = ABSORBED;
    s.lobe = LOBE_GLOSSY_REFLECTION;
    if (!(i.wo.z > 0.0)) return s;
    const float through = facetTransmittance(p, i.wo.z);
    const float share = interfaceShare(p, 1.0 - through);
    const bool isTop = u.x < share;
    const vec2 rest = leftInLobe(u.xy, isTop, share);
    const vec3 h = sampleFacet(facetsOf(p), i.wo, rest);
    s.direction = isTop ? 2.0 * dot(i.wo, h) * h - i.wo : sampleCosineHemisphere(rest);
    if (!(s.direction.z > 0.0)) return s;
    const BsdfValue f = plasticOfFacets(p, i, s.direction, share, through);
    s.pdf = f.pdf;
    s.weight = f.value / max(f.pdf, TINY);
    return s;
}
