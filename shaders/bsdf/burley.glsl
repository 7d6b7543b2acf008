// Burley's principled BSDF (2012, 2015) as Mitsuba 3 has it: the plugins principled and principledthin. The lobes are
// added, not layered: at grazing angles more can be reflected than arrives. docs/estimator.md, "Burley", has the formulas.

const bool HAS_BURLEY_TRANSMISSION = (FACETS & BURLEY_HAS_TRANSMISSION) != 0u;
const bool HAS_THIN_BURLEY = (FACETS & BURLEY_HAS_THIN) != 0u;

uint burleyLobes(BurleyParameters p) {
    const bool isThin = HAS_THIN_BURLEY && (p.flags & BURLEY_IS_THIN) != 0u;
    const bool transmits = isThin ? p.transmission > 0.0 || p.diffuseTransmission > 0.0
                                  : p.transmission > 0.0 && p.metallic < 1.0;
    return LOBE_GLOSSY_REFLECTION |
           (HAS_BURLEY_TRANSMISSION && transmits ? LOBE_GLOSSY_TRANSMISSION : 0u);
}
/// Of any of the scene's.
uint sceneBurleyLobes() {
    return LOBE_GLOSSY_REFLECTION | (HAS_BURLEY_TRANSMISSION ? LOBE_GLOSSY_TRANSMISSION : 0u);
}

/// roughness squared, stretched as Burley 2012 does it.
FacetShape burleyFacets(BurleyParameters p, float roughness) {
    const float alpha = roughness * roughness, aspect = sqrt(1.0 - 0.9 * p.anisotropy);
    return FacetShape(max(vec2(alpha / aspect, alpha * aspect), vec2(p.leastAlpha)), false, true);
}

/// The hue of the base colour, of luminance 1.
vec3 burleyTint(BurleyParameters p) {
    const float luminance = dot(p.baseColor, vec3(0.212671, 0.715160, 0.072169)); // Rec. 709
    return luminance > 0.0 ? p.baseColor / luminance : vec3(1.0);
}

/// What is seen of the material from one direction.
struct BurleyView {
    bool isThin;
    bool isInside;      ///< of a volume: only its interface is seen
    float eta;          ///< index on the side of wo over that on the other
    float opaque;       ///< weight of the diffuse lobes
    float clear;        ///< of the interface without a base
    float sheen;
    float coatAlpha;
    float diffuseShare, coatShare, throughShare; ///< probabilities; the rest is the facets'
};

BurleyView burleyView(BurleyParameters p, Incidence i) {
    BurleyView v;
    v.isThin = HAS_THIN_BURLEY && (p.flags & BURLEY_IS_THIN) != 0u;
    v.isInside = !v.isThin && !i.entering;
    v.eta = i.entering || v.isThin ? 1.0 / p.ior : p.ior;
    const float dielectric = v.isThin ? 1.0 : 1.0 - p.metallic;
    v.opaque = v.isInside ? 0.0 : dielectric * (1.0 - p.transmission);
    v.clear = dielectric * p.transmission;
    v.sheen = v.isInside ? 0.0 : p.sheen.x * (v.isThin ? 1.0 - p.transmission : dielectric);
    v.coatAlpha = mix(0.1, 0.001, p.clearcoatGloss);
    const float through = v.isThin ? p.diffuseTransmission : 0.0;
    // Sheen is found by the diffuse samples.
    const float diffuse = max(v.opaque, 0.25 * v.sheen);
    const float coat = v.isInside || v.isThin ? 0.0 : 0.25 * p.clearcoat;
    const float facets = v.isThin ? max(p.transmission, 0.0) : 1.0;
    const float sum = max(diffuse + coat + facets, TINY);
    v.diffuseShare = diffuse * (1.0 - through) / sum;
    v.throughShare = diffuse * through / sum;
    v.coatShare = coat / sum;
    return v;
}

float burleyFacetShare(BurleyView v) { return max(1.0 - v.diffuseShare - v.coatShare - v.throughShare, 0.0); }

/// What one facet does with light, seen at a cosine > 0.
struct BurleyFacet {
    vec3 reflected, transmitted;
    float cosTransmitted;
    float reflects; ///< probability with which samples are reflected
};

BurleyFacet burleyFacetAt(BurleyParameters p, BurleyView v, float cosine) {
    BurleyFacet f;
    const float fresnel = fresnelDielectric(min(cosine, 1.0), v.eta, f.cosTransmitted);
    // Schlick's approximation holds on the less dense side.
    const float weight = schlickWeight(v.eta < 1.0 ? cosine : f.cosTransmitted);
    const float r = (p.ior - 1.0) / (p.ior + 1.0);
    const vec3 tinted = schlick(r * r * burleyTint(p), 1.0, weight);
    if (v.isThin) {
        f.reflected = p.transmission * mix(vec3(fresnel), tinted, p.specularTint);
        f.transmitted = p.transmission * (1.0 - fresnel) * p.baseColor;
        f.reflects = 0.5; // reflection and transmission have facets of their own
        return f;
    }
    f.reflected = v.isInside ? vec3(v.clear * fresnel)
                             : (1.0 - p.metallic) * mix(vec3(fresnel), tinted, p.specularTint) +
                                   p.metallic * schlick(p.baseColor, 1.0, weight);
    f.transmitted = v.clear * (1.0 - fresnel) * sqrt(p.baseColor);
    const float reflected = mean(f.reflected), transmitted = mean(f.transmitted);
    f.reflects = transmitted > 0.0 ? reflected / (reflected + transmitted) : 1.0;
    f.transmitted *= v.eta * v.eta; // radiance over the squared index is invariant
    return f;
}

/// Burley 2015, figure 15: light that passes a thin sheet is spread less.
float thinRoughness(BurleyParameters p) { return (0.65 * p.ior - 0.35) * p.roughness; }

/// Microfacets, reflected or transmitted.
BsdfValue evaluateBurleyFacets(BurleyParameters p, BurleyView v, vec3 wo, vec3 wi) {
    const bool transmits = wi.z < 0.0, refracts = HAS_BURLEY_TRANSMISSION && transmits && !v.isThin;
    vec3 h = wo + vec3(wi.xy, abs(wi.z));
    if (refracts) {
        h = v.eta * wo + wi;
        h = h.z < 0.0 ? -h : h;
    }
    h = unit(h);
    const float cosO = dot(wo, h), cosI = dot(wi, h);
    if (!(cosO > 0.0) || refracts && !(cosI < 0.0)) return NO_SCATTERING;
    const FacetShape shape =
        burleyFacets(p, transmits && v.isThin ? thinRoughness(p) : p.roughness);
    const BurleyFacet face = burleyFacetAt(p, v, cosO);
    const float across = v.eta * cosO + cosI;
    const float perNormal = refracts ? cosO * abs(cosI) / max(across * across, TINY) : 0.25;
    const float area = facetArea(shape, wo), density = facetD(shape, h) * perNormal / area;
    // Facets of a thin sheet do not send light on to their own side.
    const float lit = transmits && !(cosI < 0.0) ? 0.0 : facetsLit(shape, wo, area, wi);
    return BsdfValue((transmits ? face.transmitted : face.reflected) * (density * lit),
                     density * (transmits ? 1.0 - face.reflects : face.reflects));
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
BsdfValue evaluateBurleyCoat(BurleyParameters p, BurleyView v, vec3 wo, vec3 wi) {
    const FacetShape masking = FacetShape(vec2(0.25), false, true);
    const vec3 h = unit(wo + wi);
    const float cosine = dot(wo, h), d = burleyCoatD(h, v.coatAlpha);
    float cosTransmitted;
    fresnelDielectric(min(cosine, 1.0), v.eta, cosTransmitted);
    const float fresnel = mix(CLEARCOAT_F0, 1.0, schlickWeight(v.eta < 1.0 ? cosine : cosTransmitted));
    const float g = wo.z / facetArea(masking, wo) * (wi.z / facetArea(masking, wi));
    return BsdfValue(vec3(0.25 * p.clearcoat * fresnel * d * g * wi.z), d * h.z / (4.0 * cosine));
}

/// Diffuse reflection with retro-reflection, flattened towards scattering below the surface (Hanrahan and Krueger), and
/// sheen; f cos.
vec3 burleyDiffuse(BurleyParameters p, BurleyView v, vec3 wo, vec3 wi) {
    const float cosD = dot(wi, unit(wo + wi)), fo = schlickWeight(wo.z), fi = schlickWeight(wi.z);
    const float retro = 2.0 * p.roughness * cosD * cosD;
    const float diffuse = (1.0 - 0.5 * fo) * (1.0 - 0.5 * fi) + retro * (fo + fi + fo * fi * (retro - 1.0));
    const float ss = mix(1.0, 0.5 * retro, fo) * mix(1.0, 0.5 * retro, fi);
    const float flat_ = 1.25 * (ss * (1.0 / (wo.z + wi.z) - 0.5) + 0.5);
    const vec3 sheen = v.sheen * schlickWeight(cosD) * mix(vec3(1.0), burleyTint(p), p.sheenTint);
    const float reflected = v.isThin ? 1.0 - p.diffuseTransmission : 1.0;
    return (v.opaque * INV_PI * mix(diffuse, flat_, p.flatness) * p.baseColor + sheen) * (reflected * wi.z);
}

BsdfValue evaluateAllOfBurley(BurleyParameters p, BurleyView v, vec3 wo, vec3 wi) {
    BsdfValue f = evaluateBurleyFacets(p, v, wo, wi);
    if (v.isThin && !(p.transmission > 0.0)) f = NO_SCATTERING;
    f.pdf *= burleyFacetShare(v);
    const float lambert = abs(wi.z) * INV_PI;
    if (wi.z < 0.0) {
        if (!v.isThin) return f;
        f.value += v.opaque * p.diffuseTransmission * lambert * p.baseColor;
        f.pdf += v.throughShare * lambert;
        return f;
    }
    if (v.isInside) return f;
    f.value += burleyDiffuse(p, v, wo, wi);
    f.pdf += v.diffuseShare * lambert;
    if (v.coatShare > 0.0) {
        const BsdfValue coat = evaluateBurleyCoat(p, v, wo, wi);
        f.value += coat.value;
        f.pdf += v.coatShare * coat.pdf;
    }
    return f;
}

BsdfValue evaluateBurley(BurleyParameters p, Incidence i, vec3 wi) {
    if (!(i.wo.z > 0.0) || wi.z == 0.0) return NO_SCATTERING;
    return evaluateAllOfBurley(p, burleyView(p, i), i.wo, wi);
}

/// u.x chooses the lobe, and what is left of it and u.y the direction in it; u.z chooses between reflection and
/// transmission.
BsdfSample sampleBurley(BurleyParameters p, Incidence i, vec3 u) {
    BsdfSample s = ABSORBED;
    s.lobe = LOBE_GLOSSY_REFLECTION;
    if (!(i.wo.z > 0.0)) return s;
    const BurleyView v = burleyView(p, i);
    const float diffuseEnd = v.diffuseShare, throughEnd = diffuseEnd + v.throughShare;
    const float coatEnd = throughEnd + v.coatShare;
    const bool diffuse = u.x < throughEnd, through = diffuse && u.x >= diffuseEnd;
    const bool coat = !diffuse && u.x < coatEnd;
    const float from = diffuse ? (through ? diffuseEnd : 0.0) : (coat ? throughEnd : coatEnd);
    const float to = diffuse ? (through ? throughEnd : diffuseEnd) : (coat ? coatEnd : 1.0);
    const vec2 rest = vec2(clamp((u.x - from) / (to - from), 0.0, 1.0 - UNIT_ROUNDOFF), u.y);

    // Of a thin sheet facets of their own transmit, which u.z chooses before there is a facet.
    const bool passesThin = v.isThin && u.z >= 0.5;
    const FacetShape shape = burleyFacets(p, passesThin ? thinRoughness(p) : p.roughness);
    const vec3 h = coat ? sampleBurleyCoat(v.coatAlpha, rest) : sampleFacet(shape, i.wo, rest);
    const float cosine = dot(i.wo, h);
    const BurleyFacet face = burleyFacetAt(p, v, max(cosine, 0.0));
    const bool transmits = HAS_BURLEY_TRANSMISSION && (diffuse ? through : !coat && u.z >= face.reflects);
    vec3 wi = 2.0 * cosine * h - i.wo;
    if (transmits) wi = v.isThin ? vec3(wi.xy, -wi.z) : (v.eta * cosine - face.cosTransmitted) * h - v.eta * i.wo;
    if (diffuse) {
        wi = sampleCosineHemisphere(rest);
        wi.z = through ? -wi.z : wi.z;
    }
    s.direction = wi;
    s.lobe = transmits ? LOBE_GLOSSY_TRANSMISSION : LOBE_GLOSSY_REFLECTION;
    // Below the surface that it should be above, or the other way round.
    if (transmits ? !(wi.z < 0.0) : !(wi.z > 0.0)) return s;
    const BsdfValue f = evaluateAllOfBurley(p, v, i.wo, wi);
    s.pdf = f.pdf;
    s.weight = f.pdf > 0.0 ? f.value / f.pdf : vec3(0.0);
    return s;
}
