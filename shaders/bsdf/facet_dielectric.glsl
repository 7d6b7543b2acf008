// Interfaces of microfacets between dielectrics (Walter et al. 2007), and thin sheets.

FacetShape facetsOf(FacetDielectricParameters p) {
    return facetShape(max(vec2(p.alphaX, p.alphaY), vec2(p.leastAlpha)), p.facets);
}

/// What one facet does with light, seen at a cosine > 0.
struct FacetInterface {
    vec3 reflected, transmitted;
    float cosTransmitted; ///< 0 in total reflection
    float reflects;       ///< probability with which samples are reflected
};

/// eta: index on the side of wo over that on the other.
FacetInterface interfaceAt(FacetDielectricParameters p, float eta, float cosine) {
    FacetInterface f;
    const float fresnel = fresnelDielectric(min(cosine, 1.0), eta, f.cosTransmitted);
    f.reflected = fresnel * p.reflectance;
    f.transmitted = (1.0 - fresnel) * p.transmittance;
    const float reflected = mean(f.reflected), transmitted = mean(f.transmitted);
    f.reflects = transmitted > 0.0 ? reflected / (reflected + transmitted) : 1.0;
    f.transmitted *= eta * eta; // radiance over the squared index is invariant
    return f;
}

BsdfValue evaluateFacetDielectric(FacetDielectricParameters p, Incidence i, vec3 wi) {
    const vec3 wo = i.wo;
    if (!(wo.z > 0.0) || wi.z == 0.0) return NO_SCATTERING;
    const FacetShape shape = facetsOf(p);
    const float eta = i.entering ? 1.0 / p.ior : p.ior;
    const bool transmits = wi.z < 0.0;
    vec3 h = transmits ? eta * wo + wi : wo + wi;
    h = unit(h.z < 0.0 ? -h : h);
    const float cosO = dot(wo, h), cosI = dot(wi, h);
    if (!(cosO > 0.0) || transmits && !(cosI < 0.0)) return NO_SCATTERING;
    const FacetInterface face = interfaceAt(p, eta, cosO);
    // Solid angle of normals over that of directions, times the cosine of which visible normals have one.
    const float across = eta * cosO + cosI;
    const float perNormal = transmits ? cosO * abs(cosI) / max(across * across, TINY) : 0.25;
    const float area = facetArea(shape, wo), density = facetD(shape, h) * perNormal / area;
    const float lit = facetsLit(shape, wo, area, wi);
    return BsdfValue((transmits ? face.transmitted : face.reflected) * (density * lit),
                     density * (transmits ? 1.0 - face.reflects : face.reflects));
}

/// u.z chooses between reflection and transmission.
BsdfSample sampleFacetDielectric(FacetDielectricParameters p, Incidence i, vec3 u) {
    BsdfSample s = ABSORBED;
    s.lobe = LOBE_GLOSSY_REFLECTION;
    if (!(i.wo.z > 0.0)) return s;
    const FacetShape shape = facetsOf(p);
    const float eta = i.entering ? 1.0 / p.ior : p.ior;
    const vec3 h = sampleFacet(shape, i.wo, u.xy);
    const float cosine = dot(i.wo, h);
    if (!(cosine > 0.0)) return s;
    const FacetInterface face = interfaceAt(p, eta, cosine);
    const bool transmits = u.z >= face.reflects;
    s.lobe = transmits ? LOBE_GLOSSY_TRANSMISSION : LOBE_GLOSSY_REFLECTION;
    s.direction = transmits ? (eta * cosine - face.cosTransmitted) * h - eta * i.wo
                            : 2.0 * cosine * h - i.wo;
    if (transmits ? !(s.direction.z < 0.0) : !(s.direction.z > 0.0)) return s;
    const float area = facetArea(shape, i.wo);
    const float probability = transmits ? 1.0 - face.reflects : face.reflects;
    const float across = eta * cosine - face.cosTransmitted;
    const float perNormal =
        transmits ? cosine * face.cosTransmitted / max(across * across, TINY) : 0.25;
    s.pdf = facetD(shape, h) * perNormal / area * probability;
    s.weight = (transmits ? face.transmitted : face.reflected) *
               (facetsLit(shape, i.wo, area, s.direction) / probability);
    return s;
}

/// Both interfaces of a thin sheet, and all that is reflected between them: with the reflectance R of one, R + (1 -
/// R)^2 R / (1 - R^2) = 2 R / (1 + R) is reflected and the rest transmitted, as it came.
BsdfSample sampleThinDielectric(ThinDielectricParameters p, Incidence i, vec3 u) {
    float cosTransmitted;
    const float one = fresnelDielectric(abs(i.wo.z), 1.0 / p.ior, cosTransmitted);
    if (u.z < 2.0 * one / (1.0 + one))
        return BsdfSample(vec3(-i.wo.xy, i.wo.z), p.reflectance, 0.0, LOBE_DELTA_REFLECTION);
    return BsdfSample(-i.wo, p.transmittance, 0.0, LOBE_DELTA_TRANSMISSION);
}
