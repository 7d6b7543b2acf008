// Conductors of a complex index of refraction: smooth, or of microfacets that are stretched. (The rough conductor of
// the CS184 renderer is another kind, rough_conductor.glsl.)

BsdfSample sampleConductor(ConductorParameters p, Incidence i, vec3 u) {
    const vec3 weight = p.reflectance * fresnelConductor(abs(i.wo.z), p.eta, p.k);
    return BsdfSample(vec3(-i.wo.xy, i.wo.z), weight, 0.0, LOBE_DELTA_REFLECTION);
}

FacetShape facetsOf(ConductorParameters p) {
    return facetShape(max(vec2(p.alphaX, p.alphaY), vec2(LEAST_GGX_ALPHA)), p.facets);
}

BsdfValue evaluateFacetConductor(ConductorParameters p, Incidence i, vec3 wi) {
    if (!(i.wo.z > 0.0 && wi.z > 0.0)) return NO_SCATTERING;
    const vec3 h = unit(i.wo + wi);
    BsdfValue f = reflectionByFacets(facetsOf(p), i.wo, wi, h);
    f.value *= p.reflectance * fresnelConductor(min(dot(i.wo, h), 1.0), p.eta, p.k);
    return f;
}

BsdfSample sampleFacetConductor(ConductorParameters p, Incidence i, vec3 u) {
    BsdfSample s = ABSORBED;
    s.lobe = LOBE_GLOSSY_REFLECTION;
    if (!(i.wo.z > 0.0)) return s;
    const FacetShape f = facetsOf(p);
    const vec3 h = sampleFacet(f, i.wo, u.xy);
    const float cosine = dot(i.wo, h);
    s.direction = 2.0 * cosine * h - i.wo;
    if (!(cosine > 0.0 && s.direction.z > 0.0)) return s;
    // The density of the normals is in both value and density, and drops out.
    const float area = facetArea(f, i.wo);
    s.pdf = facetD(f, h) / (4.0 * area);
    s.weight = p.reflectance * fresnelConductor(min(cosine, 1.0), p.eta, p.k) *
               facetsLit(f, i.wo, area, s.direction);
    return s;
}
