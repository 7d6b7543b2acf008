// glTF's metallic-roughness material with its extensions: a metal and a dielectric, mixed; on the
// dielectric, specular reflection over diffuse or over transmission; sheen and a clear coat on top.
// docs/estimator.md, "Principled", has the formulas. Light that microfacets would scatter again is given
// back to the lobe it comes from (Turquin 2019); layers get what those above them leave (albedo scaling).

#include "shared/albedo_fits.h"

const bool HAS_CLEARCOAT = (PRINCIPLED_FEATURES & PRINCIPLED_HAS_CLEARCOAT) != 0u;
/// Whether coats of some materials have normals of their own: DETAIL_COAT_HAS_NORMAL.
bool sceneHasCoatNormals() {
    const uint maps = 1u << TEXTURE_NORMAL | 1u << TEXTURE_CLEARCOAT_NORMAL;
    return HAS_CLEARCOAT && (TEXTURE_SLOTS & maps) != 0u;
}
const bool HAS_SHEEN = (PRINCIPLED_FEATURES & PRINCIPLED_HAS_SHEEN) != 0u;
const bool HAS_ANISOTROPY = (PRINCIPLED_FEATURES & PRINCIPLED_HAS_ANISOTROPY) != 0u;
const bool HAS_THIN_TRANSMISSION = (PRINCIPLED_FEATURES & PRINCIPLED_HAS_THIN_TRANSMISSION) != 0u;
const bool HAS_REFRACTION = (PRINCIPLED_FEATURES & PRINCIPLED_HAS_REFRACTION) != 0u;

/// Of each choice between lobes; the one of reflection and transmission excepted.
const float LEAST_FACET_SHARE = 0.015625;

uint principledLobes(PrincipledParameters p) {
    const bool transmits = (HAS_THIN_TRANSMISSION || HAS_REFRACTION) && p.transmission > 0.0 && p.metallic < 1.0;
    return LOBE_GLOSSY_REFLECTION | (transmits ? LOBE_GLOSSY_TRANSMISSION : 0u);
}
/// Of any of the scene's.
uint scenePrincipledLobes() {
    return LOBE_GLOSSY_REFLECTION | (HAS_THIN_TRANSMISSION || HAS_REFRACTION ? LOBE_GLOSSY_TRANSMISSION : 0u);
}

float mean(vec3 v) { return dot(v, vec3(1.0 / 3.0)); }

vec3 schlick(vec3 f0, float f90, float weight) { return f0 + (f90 - f0) * weight; }

float fifthPower(float x) { return x * x * x * x * x; }

/// Of Schlick's term at the cosine between direction and half vector.
float schlickWeight(float cosine) { return fifthPower(clamp(1.0 - cosine, 0.0, 1.0)); }

// --- The layers, as seen from one direction ------------------------------------------------------

/// What the parameters and wo determine. Shares are of all light; what a layer gets from those above it is in.
struct PrincipledLayers {
    vec2 alpha;
    float metallic, transmission; ///< transmission: of the dielectric
    vec3 baseColor;
    vec3 f0; ///< of the dielectric
    float f90;
    float index;      ///< inside over outside
    float eta;        ///< index on the side of wo over that on the other
    bool thin;
    float base;       ///< what the coat and the sheen leave
    float albedo;     ///< ggxAlbedo() of the microfacets
    vec3 diffuse;     ///< albedo of the diffuse lobe
    vec3 coatNormal;  ///< with sceneHasCoatNormals()
    float coat;       ///< strength, with what is given back
    float coatAlpha;
    vec3 sheen;       ///< colour, under the coat
    float sheenAlpha;
    float coatShare, sheenShare, diffuseShare; ///< probabilities; the rest is the facets'
};

/// To the frame of the coat's normal, and back.
vec3 toCoat(PrincipledLayers l, vec3 w) { return sceneHasCoatNormals() ? toLocal(makeFrame(l.coatNormal), w) : w; }
vec3 fromCoat(PrincipledLayers l, vec3 w) { return sceneHasCoatNormals() ? toWorld(makeFrame(l.coatNormal), w) : w; }

/// What is given back to a lobe whose facets reflect f0 at normal incidence.
vec3 givenBack(vec3 f0, float albedo) { return 1.0 + f0 * (1.0 / albedo - 1.0); }

vec2 facetAlpha(PrincipledParameters p) {
    const float alpha = max(p.roughness * p.roughness, p.leastAlpha);
    if (!HAS_ANISOTROPY) return vec2(alpha);
    return vec2(mix(alpha, 1.0, p.anisotropy * p.anisotropy), alpha);
}

PrincipledLayers layersOf(PrincipledParameters p, Incidence i) {
    PrincipledLayers l;
    const float mu = i.wo.z;
    l.alpha = facetAlpha(p);
    l.metallic = p.metallic;
    l.transmission = HAS_THIN_TRANSMISSION || HAS_REFRACTION ? p.transmission : 0.0;
    l.baseColor = p.baseColor;
    l.thin = !HAS_REFRACTION || HAS_THIN_TRANSMISSION && (p.flags & PRINCIPLED_IS_THIN) != 0u;
    const bool fromOutside = (p.flags & PRINCIPLED_IS_THIN) != 0u || i.entering;
    l.index = p.ior;
    l.eta = i.entering ? 1.0 / p.ior : p.ior;
    const float r = (p.ior - 1.0) / (p.ior + 1.0);
    l.f0 = min(r * r * p.specularColor, vec3(1.0)) * p.specular;
    l.f90 = p.specular;

    // The coat.
    float left = 1.0;
    l.coat = 0.0;
    l.coatShare = 0.0;
    if (HAS_CLEARCOAT) {
        l.coatAlpha = max(p.clearcoatRoughness * p.clearcoatRoughness, LEAST_GGX_ALPHA);
        l.coatNormal = i.coat;
        const float coatMu = sceneHasCoatNormals() ? dot(i.wo, i.coat) : mu;
        const float albedo = ggxAlbedo(coatMu, l.coatAlpha);
        l.coat = fromOutside && coatMu > 0.0 ? p.clearcoat * (1.0 + CLEARCOAT_F0 * (1.0 / albedo - 1.0)) : 0.0;
        l.coatShare = l.coat * albedo * mix(CLEARCOAT_F0, 1.0, schlickShare(coatMu, l.coatAlpha));
        left -= l.coatShare;
    }
    // Sheen.
    l.sheen = vec3(0.0);
    l.sheenShare = 0.0;
    if (HAS_SHEEN) {
        l.sheenAlpha = max(p.sheenRoughness * p.sheenRoughness, LEAST_SHEEN_ALPHA);
        l.sheen = fromOutside ? left * p.sheenColor : vec3(0.0);
        const float albedo = sheenAlbedo(max(mu, LEAST_SHEEN_COSINE), l.sheenAlpha);
        l.sheenShare = mean(l.sheen) * albedo;
        left -= largestComponent(l.sheen) * albedo;
    }
    // Metal and dielectric. Stretched facets are given back what narrower round ones are.
    l.base = max(left, 0.0);
    l.albedo = ggxAlbedo(mu, l.alpha.y);
    const float weight = schlickShare(mu, l.alpha.y);
    const vec3 dielectric =
        l.albedo * schlick(l.f0, l.f90, weight) * givenBack(l.f0, l.albedo);
    const vec3 metal =
        l.albedo * schlick(l.baseColor, 1.0, weight) * givenBack(l.baseColor, l.albedo);
    const float opaque = (1.0 - l.metallic) * (1.0 - l.transmission);
    l.diffuse = l.base * opaque * max(1.0 - largestComponent(dielectric), 0.0) * l.baseColor;
    l.diffuseShare = mean(l.diffuse);
    const float facets =
        l.base * mean(l.metallic * metal + opaque * dielectric +
                      vec3((1.0 - l.metallic) * l.transmission));
    const float sum = l.coatShare + l.sheenShare + l.diffuseShare + max(facets, LEAST_FACET_SHARE);
    l.coatShare /= sum;
    l.sheenShare /= sum;
    l.diffuseShare /= sum;
    return l;
}

float facetShare(PrincipledLayers l) { return 1.0 - l.coatShare - l.sheenShare - l.diffuseShare; }

// --- The microfacets ---------------------------------------------------------------------------

/// What one microfacet reflects and transmits, seen at a cosine > 0.
struct Facet {
    vec3 reflected, transmitted;
    float reflects; ///< probability, of both, with which samples are reflected
};

/// Reflectance of the interface around a volume: Fresnel's equations, from f0 to f90 as they go from
/// normal incidence to 1; total reflection is total.
vec3 interfaceReflectance(PrincipledLayers l, float cosine) {
    float cosTransmitted;
    const float exact = fresnelDielectric(cosine, l.eta, cosTransmitted);
    if (cosTransmitted == 0.0) return vec3(1.0);
    const float r = (l.index - 1.0) / (l.index + 1.0), normal = r * r;
    return schlick(l.f0, l.f90, max((exact - normal) / (1.0 - normal), 0.0));
}

Facet facetAt(PrincipledLayers l, float cosine) {
    const float weight = schlickWeight(cosine);
    const vec3 dielectric = schlick(l.f0, l.f90, weight);
    const float opaque = (1.0 - l.metallic) * (1.0 - l.transmission);
    Facet f;
    f.reflected = l.metallic * schlick(l.baseColor, 1.0, weight) * givenBack(l.baseColor, l.albedo) +
                  opaque * dielectric * givenBack(l.f0, l.albedo);
    f.transmitted = vec3(0.0);
    f.reflects = 1.0;
    if (HAS_THIN_TRANSMISSION || HAS_REFRACTION) {
        const float share = (1.0 - l.metallic) * l.transmission;
        vec3 mirrored = dielectric;
        float scale = share / l.albedo;
        if (!l.thin) {
            mirrored = interfaceReflectance(l, cosine);
            scale = share;
        }
        f.reflected += scale * mirrored;
        f.transmitted = scale * max(1.0 - largestComponent(mirrored), 0.0) * l.baseColor;
        const float reflected = mean(f.reflected), transmitted = mean(f.transmitted);
        f.reflects = transmitted > 0.0 ? reflected / (reflected + transmitted) : 1.0;
        // Radiance over the squared index is invariant.
        if (!l.thin) f.transmitted *= l.eta * l.eta;
    }
    return f;
}

/// The facet's frame, x along the direction of the greater roughness, and back.
vec3 alongGrain(PrincipledParameters p, vec3 w) {
    if (!HAS_ANISOTROPY) return w;
    const vec2 turn = vec2(cos(p.anisotropyRotation), sin(p.anisotropyRotation));
    return vec3(turn.x * w.x + turn.y * w.y, turn.x * w.y - turn.y * w.x, w.z);
}
vec3 acrossGrain(PrincipledParameters p, vec3 w) {
    if (!HAS_ANISOTROPY) return w;
    const vec2 turn = vec2(cos(p.anisotropyRotation), sin(p.anisotropyRotation));
    return vec3(turn.x * w.x - turn.y * w.y, turn.x * w.y + turn.y * w.x, w.z);
}

/// Microfacets, reflected or transmitted. wo, wi: along the grain.
BsdfValue evaluateFacets(PrincipledLayers l, vec3 wo, vec3 wi) {
    const bool transmits = wi.z < 0.0;
    const bool refracts = HAS_REFRACTION && transmits && !l.thin;
    vec3 h = wo + vec3(wi.xy, abs(wi.z));
    if (refracts) {
        h = l.eta * wo + wi;
        h = h.z < 0.0 ? -h : h;
    }
    h = unit(h);
    const float cosO = dot(wo, h);
    // Reflected light is about h, and its normals are 4 cosO times as dense as it.
    float perNormal = 1.0 / 4.0, onIt = 1.0; // over cosO
    if (refracts) {
        const float cosI = dot(wi, h), across = l.eta * cosO + cosI;
        onIt = cosO > 0.0 && cosI < 0.0 ? 1.0 : 0.0;
        perNormal = cosO * abs(cosI) / max(across * across, TINY);
    }
    if (!(cosO > 0.0 && onIt > 0.0)) return NO_SCATTERING;
    const Facet f = facetAt(l, cosO);
    const float density = visibleNormals(wo, h, l.alpha) * perNormal;
    // D G2 / cos wo, from the visible normals D G1 / cos wo.
    const float g2OverG1 = 2.0 * ggxVisibility(wo, wi, l.alpha) * abs(wi.z) *
                           (wo.z + stretchedLength(wo, l.alpha));
    return BsdfValue((transmits ? f.transmitted : f.reflected) * (density * g2OverG1),
                     density * (transmits ? 1.0 - f.reflects : f.reflects));
}

/// Where a facet whose normal is h sends light.
vec3 leaveFacet(PrincipledLayers l, vec3 wo, vec3 h, bool reflects) {
    const float cosine = dot(wo, h);
    const vec3 reflected = 2.0 * cosine * h - wo;
    if (reflects) return reflected;
    if (l.thin) return vec3(reflected.xy, -reflected.z);
    const float sin2 = l.eta * l.eta * max(1.0 - cosine * cosine, 0.0);
    return (l.eta * cosine - sqrt(max(1.0 - sin2, 0.0))) * h - l.eta * wo;
}

// --- Sheen -------------------------------------------------------------------------------------
// Estevez and Kulla, "Production Friendly Microfacet Sheen BRDF" (2017): a distribution of fibres
// that stand up, and a fit of its Lambda, which the authors and KHR_materials_sheen give.

float sheenFit(float x, float alpha) {
    const float t = (1.0 - alpha) * (1.0 - alpha);
    const float a = mix(21.5473, 25.3245, t), b = mix(3.82987, 3.32435, t);
    const float c = mix(0.19823, 0.16801, t), d = mix(-1.97760, -1.27393, t);
    const float e = mix(-4.32054, -4.85967, t);
    return a / (1.0 + b * pow(x, c)) + d * x + e;
}

float sheenLambda(float cosine, float alpha) {
    const float fit = sheenFit(min(cosine, 1.0 - cosine), alpha);
    return exp(cosine < 0.5 ? fit : 2.0 * sheenFit(0.5, alpha) - fit);
}

/// f of sheen of colour 1. Cosines below the least are taken for it: the fit of Lambda falls short there.
float sheenValue(float alpha, vec3 wo, vec3 wi) {
    const vec3 h = unit(wo + wi);
    const float sine = min(length(h.xy), 1.0), inverse = 1.0 / alpha;
    const float d = (2.0 + inverse) * pow(sine, inverse) * (0.5 * INV_PI);
    const float cosO = clamp(wo.z, LEAST_SHEEN_COSINE, 1.0), cosI = clamp(wi.z, LEAST_SHEEN_COSINE, 1.0);
    const float lambdas = sheenLambda(cosO, alpha) + sheenLambda(cosI, alpha);
    return d / ((1.0 + lambdas) * 4.0 * cosO * cosI);
}

// --- All together ---------------------------------------------------------------------------------

BsdfValue evaluateLayers(PrincipledParameters p, PrincipledLayers l, vec3 wo, vec3 wi) {
    BsdfValue f = evaluateFacets(l, alongGrain(p, wo), alongGrain(p, wi));
    f.value *= l.base;
    f.pdf *= facetShare(l);
    if (wi.z < 0.0) return f;
    const float lambert = wi.z * INV_PI;
    f.value += l.diffuse * lambert;
    f.pdf += l.diffuseShare * lambert;
    if (HAS_SHEEN) {
        f.value += l.sheen * (sheenValue(l.sheenAlpha, wo, wi) * wi.z);
        f.pdf += l.sheenShare * (0.5 * INV_PI);
    }
    if (HAS_CLEARCOAT) {
        const vec2 alpha = vec2(l.coatAlpha);
        const vec3 coatWo = toCoat(l, wo), coatWi = toCoat(l, wi), h = unit(coatWo + coatWi);
        const bool isMet = sceneHasCoatNormals() ? coatWo.z > 0.0 && coatWi.z > 0.0 : true;
        const float density = isMet ? visibleNormals(coatWo, h, alpha) * 0.25 : 0.0;
        const float fresnel = mix(CLEARCOAT_F0, 1.0, schlickWeight(dot(coatWo, h)));
        const float visibility = isMet ? ggxVisibility(coatWo, coatWi, alpha) : 0.0;
        f.value += vec3(l.coat * fresnel * density * 2.0 * visibility * coatWi.z *
                        (coatWo.z + stretchedLength(coatWo, alpha)));
        f.pdf += l.coatShare * density;
    }
    return f;
}

BsdfValue evaluatePrincipled(PrincipledParameters p, Incidence i, vec3 wi) {
    if (!(i.wo.z > 0.0) || wi.z == 0.0) return NO_SCATTERING;
    return evaluateLayers(p, layersOf(p, i), i.wo, wi);
}

/// u.x chooses the lobe, and what is left of it and u.y the direction in it; u.z chooses between
/// reflection and transmission.
BsdfSample samplePrincipled(PrincipledParameters p, Incidence i, vec3 u) {
    BsdfSample s = ABSORBED;
    s.lobe = LOBE_GLOSSY_REFLECTION;
    if (!(i.wo.z > 0.0)) return s;
    const PrincipledLayers l = layersOf(p, i);
    const float diffuseEnd = l.diffuseShare, sheenEnd = diffuseEnd + l.sheenShare;
    const float coatEnd = sheenEnd + l.coatShare;
    const bool diffuse = u.x < diffuseEnd, sheen = !diffuse && HAS_SHEEN && u.x < sheenEnd;
    const bool coat = !diffuse && !sheen && HAS_CLEARCOAT && u.x < coatEnd;
    const float from = diffuse ? 0.0 : (sheen ? diffuseEnd : (coat ? sheenEnd : coatEnd));
    const float to = diffuse ? diffuseEnd : (sheen ? sheenEnd : (coat ? coatEnd : 1.0));
    const vec2 rest = vec2(clamp((u.x - from) / (to - from), 0.0, 1.0 - UNIT_ROUNDOFF), u.y);

    const vec3 wo = coat ? toCoat(l, i.wo) : alongGrain(p, i.wo);
    const vec3 h = sampleVisibleNormal(wo, coat ? vec2(l.coatAlpha) : l.alpha, rest);
    const float cosO = dot(wo, h);
    const bool transmits =
        !(diffuse || sheen || coat) && cosO > 0.0 && u.z >= facetAt(l, cosO).reflects;
    vec3 wi = leaveFacet(l, wo, h, !transmits);
    const bool isLost = coat && !(wi.z > 0.0); // below the coat's own horizon, where it has no density
    wi = coat ? fromCoat(l, wi) : acrossGrain(p, wi);
    if (diffuse) wi = sampleCosineHemisphere(rest);
    if (HAS_SHEEN && sheen) wi = sampleUniformHemisphere(rest);
    s.direction = wi;
    s.lobe = transmits ? LOBE_GLOSSY_TRANSMISSION : LOBE_GLOSSY_REFLECTION;
    // Below the surface that it should be above, or the other way round.
    if (isLost || (transmits ? !(wi.z < 0.0) : !(wi.z > 0.0))) return s;
    const BsdfValue f = evaluateLayers(p, l, i.wo, wi);
    s.pdf = f.pdf;
    s.weight = f.value / max(f.pdf, TINY);
    return s;
}
