// Burley's principled BSDF (2012, 2015) as Mitsuba 3 has it: the plugins principled and principledthin. The lobes are
// added, not layered: at grazing angles more can be reflected than arrives. docs/theory/surfaces.md, "Burley", has the formulas.

/// roughness squared, stretched as Burley 2012 does it.
FacetShape burleyFacets(BurleyParameters p, float roughness) {
    const float alpha = roughness * roughness, aspect = sqrt(1.0 - 0.9 * p.anisotropy);
    return FacetShape(max(vec2(alpha / aspect, alpha * aspect), vec2(p.leastAlpha)), false, true);
}

/// The hue of the base colour, of luminance 1.
vec3 burleyTint(BurleyParameters p) {
    const float luminance = dot(p.baseColor, vec3(0.212671, 0.715160, 0.072169)); // Rec. 709
    return luminance > 0.0 ? p.baseColor * (1.0 / max(luminance, TINY)) : vec3(1.0);
}

/// Burley 2015, figure 15: light that passes a thin sheet is spread less.
float thinRoughness(BurleyParameters p) { return (0.65 * p.ior - 0.35) * p.roughness; }

void burleyClosures(inout Closures c, Material m, BurleyParameters p, Incidence i) {
    c.isSmooth = false;
    c.isThin = hasClosure(m, INTERFACE_IS_THIN);
    c.facets = burleyFacets(p, p.roughness);
    c.thinFacets = burleyFacets(p, thinRoughness(p));
    if (sceneHas(FACETS_ARE_TURNED)) c.grain = vec2(1.0, 0.0);
    // What lets no light in has no inside: both of its sides are alike, where nothing says that one is black.
    const bool isInside = !c.isThin && !i.entering && p.transmission > 0.0;
    c.eta = isInside ? p.ior : 1.0 / p.ior;
    const float dielectric = c.isThin ? 1.0 : 1.0 - p.metallic;
    const float opaque = isInside ? 0.0 : dielectric * (1.0 - p.transmission);
    const float sheen = isInside ? 0.0 : p.sheen * (c.isThin ? 1.0 - p.transmission : dielectric);
    const float passed = c.isThin ? p.diffuseTransmission : 0.0;
    c.burley = BurleyInterface(isInside, dielectric * p.transmission, burleyTint(p));
    c.interfaceWeight = c.isThin && !(p.transmission > 0.0) ? 0.0 : 1.0;
    c.diffuse = opaque * (1.0 - passed) * p.baseColor;
    c.through = opaque * passed * p.baseColor;
    c.sheen = sheen * (1.0 - passed) * mix(vec3(1.0), c.burley.tint, p.sheenTint);
    c.coat = isInside || c.isThin ? 0.0 : 0.25 * p.clearcoat;
    c.coatAlpha = mix(0.1, 0.001, p.clearcoatGloss);
    // Sheen is found by the diffuse samples.
    const float diffuse = max(opaque, 0.25 * sheen), facets = c.isThin ? max(p.transmission, 0.0) : 1.0;
    const float sum = max(diffuse + c.coat + facets, TINY);
    c.diffuseShare = diffuse * (1.0 - passed) / sum;
    c.throughShare = diffuse * passed / sum;
    c.sheenShare = 0.0;
    c.coatShare = c.coat / sum;
}

/// exact, cosTransmitted: as statedLight() has them.
InterfaceLight burleyLight(Closures c, BurleyParameters p, float cosine, float exact, float cosTransmitted) {
    InterfaceLight f = InterfaceLight(vec3(0.0), vec3(0.0), cosTransmitted, 1.0);
    // Schlick's approximation holds on the less dense side.
    const float weight = schlickWeight(c.eta < 1.0 ? cosine : cosTransmitted);
    const float r = (p.ior - 1.0) / (p.ior + 1.0);
    const vec3 tinted = schlick(r * r * c.burley.tint, 1.0, weight);
    f.reflected = c.burley.isInside ? vec3(c.burley.clear * exact)
                                    : (1.0 - p.metallic) * mix(vec3(exact), tinted, p.specularTint) +
                                          p.metallic * schlick(p.baseColor, 1.0, weight);
    f.transmitted = c.burley.clear * (1.0 - exact) * sqrt(p.baseColor);
    if (c.isThin) {
        f.reflected = p.transmission * mix(vec3(exact), tinted, p.specularTint);
        f.transmitted = p.transmission * (1.0 - exact) * p.baseColor;
    }
    return f;
}

/// The coat's distribution (GTR with the exponent 1), per steradian.
float burleyCoatD(vec3 h, float alpha) {
    const float a2 = alpha * alpha;
    return (a2 - 1.0) / (PI * log(a2) * (dot(h.xy, h.xy) + a2 * h.z * h.z));
}

vec3 sampleBurleyCoat(float alpha, vec2 u) {
    const float a2 = alpha * alpha;
    const float sin2 = clamp((pow(a2, 1.0 - u.x) - a2) / (1.0 - a2), 0.0, 1.0);
    return vec3(sqrt(sin2) * cosSin(4.0 * u.y), sqrt(1.0 - sin2));
}

/// Its value f cos and density. Its masking is that of GGX facets of the alpha 1/4.
BsdfValue burleyCoat(Closures c, vec3 wi) {
    const FacetShape masking = FacetShape(vec2(0.25), false, true);
    const vec3 h = unit(c.wo + wi);
    const float cosine = dot(c.wo, h), d = burleyCoatD(h, c.coatAlpha);
    float cosTransmitted;
    fresnelDielectric(min(cosine, 1.0), c.eta, cosTransmitted);
    const float fresnel = mix(CLEARCOAT_F0, 1.0, schlickWeight(c.eta < 1.0 ? cosine : cosTransmitted));
    const float g = c.wo.z / facetArea(masking, c.wo) * (wi.z / facetArea(masking, wi));
    return BsdfValue(vec3(c.coat * fresnel * d * g * wi.z), d * h.z / (4.0 * cosine));
}

/// Diffuse reflection with retro-reflection, flattened towards scattering below the surface (Hanrahan and Krueger), over
/// Lambert's.
float burleyDiffuse(BurleyParameters p, vec3 wo, vec3 wi) {
    const float cosD = dot(wi, unit(wo + wi)), fo = schlickWeight(wo.z), fi = schlickWeight(wi.z);
    const float retro = 2.0 * p.roughness * cosD * cosD;
    const float diffuse = (1.0 - 0.5 * fo) * (1.0 - 0.5 * fi) + retro * (fo + fi + fo * fi * (retro - 1.0));
    const float ss = mix(1.0, 0.5 * retro, fo) * mix(1.0, 0.5 * retro, fi);
    const float flat_ = 1.25 * (ss * (1.0 / (wo.z + wi.z) - 0.5) + 0.5);
    return mix(diffuse, flat_, p.flatness);
}
