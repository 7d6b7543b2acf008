// The interface of a material and the coat on it: what they do with light at one of their facets, or as planes; their
// facets' values and densities, and the directions of their samples.

/// The frame of the facets, x along the direction of the first alpha, and back.
vec3 alongGrain(Closures c, vec3 w) {
    if (!sceneHas(FACETS_ARE_TURNED)) return w;
    return vec3(c.grain.x * w.x + c.grain.y * w.y, c.grain.x * w.y - c.grain.y * w.x, w.z);
}
vec3 acrossGrain(Closures c, vec3 w) {
    if (!sceneHas(FACETS_ARE_TURNED)) return w;
    return vec3(c.grain.x * w.x - c.grain.y * w.y, c.grain.x * w.y + c.grain.y * w.x, w.z);
}

/// To the frame of the coat's normal, and back.
vec3 toCoat(Closures c, vec3 w) { return sceneHasCoatNormals() ? toLocal(makeFrame(c.coatNormal), w) : w; }
vec3 fromCoat(Closures c, vec3 w) { return sceneHasCoatNormals() ? toWorld(makeFrame(c.coatNormal), w) : w; }

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

/// What the interface does with light that meets a facet, or the plane, at a cosine > 0. cosI: between the normal and
/// the direction of light that it reflects.
InterfaceLight interfaceLight(Material m, Closures c, float cosine, float cosI) {
    const float met = min(cosine, 1.0);
    float exact = 1.0, cosTransmitted = 0.0;
    if (sceneHas(INTERFACE_IS_DIELECTRIC)) exact = fresnelDielectric(met, c.eta, cosTransmitted);
    const bool isPrincipled = hasClosure(m, RECIPE_PRINCIPLED), isBurley = hasClosure(m, RECIPE_BURLEY);
    InterfaceLight f = InterfaceLight(vec3(0.0), vec3(0.0), cosTransmitted, 1.0);
    if (!isPrincipled && !isBurley) f = statedLight(m, statedParameters(m), c, met, cosI, exact, cosTransmitted);
    if (isPrincipled) f = principledLight(c, cosine, exact, cosTransmitted);
    if (isBurley) f = burleyLight(c, burleyParameters(m), cosine, exact, cosTransmitted);
    if (!SCENE_TRANSMITS) return f;
    const float reflected = mean(f.reflected), transmitted = mean(f.transmitted);
    f.reflects = transmitted > 0.0 ? reflected / (reflected + transmitted) : 1.0;
    // Reflection and transmission of a sheet of Burley's model have facets of their own.
    if (isBurley && c.isThin) f.reflects = 0.5;
    // Radiance over the squared index is invariant.
    if (!c.isThin) f.transmitted *= c.isSmooth ? radianceCompression(c.eta) : c.eta * c.eta;
    return f;
}

/// Whether light goes from wo to wi through the interface, bent.
bool isBent(Closures c, vec3 wi) { return SCENE_REFRACTS && wi.z < 0.0 && !c.isThin; }

/// The normal of the facets that send light from wo to wi: between both; of a sheet, between wo and what it would
/// reflect.
vec3 normalBetween(Closures c, vec3 wo, vec3 wi) {
    vec3 h = wo + vec3(wi.xy, abs(wi.z));
    if (isBent(c, wi)) {
        h = c.eta * wo + wi;
        h = h.z < 0.0 ? -h : h;
    }
    return unit(h);
}

/// The interface's microfacets, reflected or transmitted. wo, wi, h: along the grain; h: normalBetween() them.
BsdfValue evaluateFacets(Material m, Closures c, vec3 wo, vec3 wi, vec3 h) {
    const bool transmits = wi.z < 0.0, bends = isBent(c, wi);
    const bool isSheet = hasClosure(m, RECIPE_BURLEY) && c.isThin;
    const float cosO = dot(wo, h), cosI = dot(wi, h);
    FacetShape shape = c.facets;
    if (isSheet && transmits) shape = c.thinFacets;
    const InterfaceLight face = interfaceLight(m, c, cosO, wi.z);
    // Solid angle of normals over that of directions, times the cosine of which visible normals have one.
    const float across = c.eta * cosO + cosI;
    const float perNormal = bends ? cosO * abs(cosI) / max(across * across, TINY) : 0.25;
    const float area = facetArea(shape, wo), density = facetD(shape, h) * perNormal / area;
    // Facets of a sheet of Burley's model do not send light on to their own side.
    const float lit = isSheet && transmits && !(cosI < 0.0) ? 0.0 : facetsLit(shape, wo, area, wi);
    BsdfValue f = BsdfValue((transmits ? face.transmitted : face.reflected) * (density * lit),
                            density * (transmits ? 1.0 - face.reflects : face.reflects));
    const bool possible = cosO > 0.0 && (!bends || cosI < 0.0) && !c.isSmooth;
    if (!possible) f = NO_SCATTERING;
    return f;
}

/// Light of three channels has three indices where a volume disperses. The interface as one of them meets it.
Closures ofChannel(Closures c, uint channel) {
    c.principled.index = max(c.principled.index + c.principled.spread * (float(channel) - 1.0), 1.0 + LEAST_INDEX_STEP);
    c.eta = c.eta > 1.0 ? c.principled.index : 1.0 / c.principled.index;
    return c;
}

bool disperses(Material m, Closures c) {
    return HAS_DISPERSION && hasClosure(m, RECIPE_PRINCIPLED) && c.principled.spread > 0.0;
}

/// Samples follow each channel in a third of the cases: the density is the mean of theirs, and no channel's value is
/// more than three times its own (the balance heuristic of Veach).
BsdfValue evaluateDispersed(Material m, Closures c, vec3 wo, vec3 wi) {
    BsdfValue f = NO_SCATTERING;
    uint channel = 0u;
    do {
        const Closures one = ofChannel(c, channel);
        const BsdfValue facets = evaluateFacets(m, one, wo, wi, normalBetween(one, wo, wi));
        f.value += facets.value * vec3(equal(uvec3(channel), uvec3(0u, 1u, 2u)));
        f.pdf += facets.pdf * (1.0 / 3.0);
        ++channel;
    } while (channel < 3u);
    return f;
}

/// The clear coat of glTF's model: f cos and density.
BsdfValue evaluateCoat(Closures c, vec3 wi) {
    const vec3 wo_ = toCoat(c, c.wo), wi_ = toCoat(c, wi);
    const FacetShape shape = FacetShape(vec2(c.coatAlpha), false, false);
    const vec3 h = unit(wo_ + wi_);
    const float area = facetArea(shape, wo_), density = ggxD(h, shape.alpha) * 0.25 / area;
    const float fresnel = mix(CLEARCOAT_F0, 1.0, schlickWeight(dot(wo_, h)));
    BsdfValue f = BsdfValue(vec3(c.coat * fresnel * density * facetsLit(shape, wo_, area, wi_)), density);
    if (!(wo_.z > 0.0 && wi_.z > 0.0)) f = NO_SCATTERING;
    return f;
}

/// A direction of the interface or of the coat, on the side that it may be on.
struct LeftFacet {
    vec3 direction;
    vec3 h;            ///< the facet's normal, along the grain
    InterfaceLight light; ///< of a plane, or where the scene transmits
    bool transmits;
    bool isPossible;
};

/// u: the direction; side: chooses between reflection and transmission.
LeftFacet leaveFacet(Material m, Closures c, bool ofCoat, vec2 u, float side) {
    LeftFacet l;
    const bool isBurley = hasClosure(m, RECIPE_BURLEY);
    // A sheet of Burley's model transmits by facets of their own, which are chosen before there is a facet.
    const bool passes = isBurley && c.isThin && side >= 0.5;
    const vec3 wo = HAS_COAT && ofCoat ? toCoat(c, c.wo) : alongGrain(c, c.wo);
    l.h = vec3(0.0, 0.0, FACES_FORWARD || wo.z >= 0.0 ? 1.0 : -1.0);
    if (HAS_FACETS) {
        FacetShape shape = c.facets;
        if (isBurley && passes) shape = c.thinFacets;
        if (HAS_COAT && ofCoat) shape = FacetShape(vec2(c.coatAlpha), false, false);
        const vec3 facet = sampleFacet(shape, wo, u);
        if (!c.isSmooth) l.h = facet;
    }
    if (HAS_COAT && isBurley && ofCoat) l.h = sampleBurleyCoat(c.coatAlpha, u);
    const float cosine = dot(wo, l.h);
    const vec3 reflected = 2.0 * cosine * l.h - wo;
    l.light = interfaceLight(m, c, max(cosine, 0.0), reflected.z);
    l.transmits = SCENE_TRANSMITS && !ofCoat && side >= l.light.reflects;
    vec3 wi = reflected;
    if (l.transmits) {
        wi = vec3(reflected.xy, -reflected.z);
        if (SCENE_REFRACTS && !c.isThin) wi = (c.eta * cosine - l.light.cosTransmitted) * l.h - c.eta * wo;
    }
    l.isPossible = c.isSmooth || (cosine > 0.0 && (ofCoat ? wi.z > 0.0 : true));
    l.direction = HAS_COAT && ofCoat ? fromCoat(c, wi) : acrossGrain(c, wi);
    return l;
}
