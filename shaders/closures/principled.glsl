// glTF's metallic-roughness material with its extensions: a metal and a dielectric, mixed; on the
// dielectric, specular reflection over diffuse or over transmission; sheen and a clear coat on top.
// docs/theory/surfaces.md, "Principled", has the formulas. Light that microfacets would scatter again is given
// back to the lobe it comes from (Turquin 2019, Kulla and Conty 2017); layers get what those above them leave (albedo scaling).

#include "shared/albedo_fits.h"

/// Each choice between lobes leaves this much to the facets; the one of reflection and transmission excepted.
const float LEAST_FACET_SHARE = 0.015625;

/// What is given back to a lobe whose facets reflect `mean` on the mean: what is missing of a lobe that reflects everything,
/// less what is absorbed where light meets facets again and again, the share meanAlbedo leaving each time.
vec3 givenBack(vec3 mean, float albedo, float meanAlbedo) {
    return 1.0 + mean * meanAlbedo / (1.0 - mean * (1.0 - meanAlbedo)) * (1.0 / albedo - 1.0);
}

vec2 facetAlpha(PrincipledParameters p) {
    const float alpha = max(p.roughness * p.roughness, p.leastAlpha);
    if (!sceneHas(FACETS_ARE_TURNED)) return vec2(alpha);
    return vec2(mix(alpha, 1.0, p.anisotropy * p.anisotropy), alpha);
}

/// What a thin film makes of the reflectance `plain` of a surface that reflects f0 at normal incidence, f90 at grazing.
vec3 underFilm(PrincipledInterface l, vec3 plain, float cosine, vec3 f0, float f90) {
    vec3 reflectance = plain;
    if (HAS_IRIDESCENCE) {
        const vec3 film = f90 * filmReflectance(cosine, f0 / max(f90, TINY), l.filmIor, l.filmThickness);
        if (l.film > 0.0) reflectance = mix(plain, film, l.film);
    }
    return reflectance;
}

vec3 givenByDielectric(PrincipledInterface l) {
    const vec3 mean = HAS_IRIDESCENCE ? l.given : schlick(l.f0, l.f90, MEAN_SCHLICK_WEIGHT);
    return givenBack(mean, l.albedo, l.meanAlbedo);
}
vec3 givenByMetal(PrincipledInterface l) {
    const vec3 mean = HAS_IRIDESCENCE ? l.givenMetal : schlick(l.baseColor, 1.0, MEAN_SCHLICK_WEIGHT);
    return givenBack(mean, l.albedo, l.meanAlbedo);
}

/// Facets whose mean of Schlick's weight is this reflect about what one at this cosine does, for which the weight is so.
float meanCosine(float weight) { return 1.0 - pow(clamp(weight, 0.0, 1.0), 0.2); }

/// Shares are of all light; what a layer gets from those above it is in the weights.
/// isSmooth: clear glass, of which the facets are one plane.
void principledClosures(inout Closures c, PrincipledParameters p, Incidence i, bool isSmooth) {
    PrincipledInterface l;
    const float mu = i.wo.z;
    c.isSmooth = isSmooth;
    c.facets = FacetShape(facetAlpha(p), false, false);
    if (sceneHas(FACETS_ARE_TURNED)) c.grain = vec2(cos(p.anisotropyRotation), sin(p.anisotropyRotation));
    const bool isThin = p.spread < 0.0;
    l.metallic = p.metallic;
    l.transmission = SCENE_TRANSMITS ? p.transmission : 0.0;
    l.baseColor = p.baseColor;
    c.isThin = !SCENE_REFRACTS || isThin;
    const bool fromOutside = isThin || i.entering;
    l.index = p.ior;
    l.spread = max(p.spread, 0.0);
    c.eta = i.entering ? 1.0 / p.ior : p.ior;
    const float r = (p.ior - 1.0) / (p.ior + 1.0);
    l.f0 = min(r * r * p.specularColor, vec3(1.0)) * p.specular;
    l.f90 = p.specular;
    l.isInside = !fromOutside;
    l.film = p.iridescence;
    l.filmIor = p.filmIor;
    l.filmThickness = p.filmThickness + p.filmSpan;

    // The coat.
    float left = 1.0;
    if (HAS_COAT) {
        c.coatAlpha = max(p.clearcoatRoughness * p.clearcoatRoughness, LEAST_GGX_ALPHA);
        c.coatNormal = i.coat;
        const float coatMu = sceneHasCoatNormals() ? dot(i.wo, i.coat) : mu;
        const float albedo = ggxAlbedo(coatMu, c.coatAlpha);
        const float mean = mix(CLEARCOAT_F0, 1.0, MEAN_SCHLICK_WEIGHT);
        const float given = givenBack(vec3(mean), albedo, ggxMeanAlbedo(c.coatAlpha)).x;
        c.coat = fromOutside && coatMu > 0.0 ? p.clearcoat * given : 0.0;
        c.coatShare = c.coat * albedo * mix(CLEARCOAT_F0, 1.0, schlickShare(coatMu, c.coatAlpha));
        left -= c.coatShare;
    }
    if (HAS_SHEEN) {
        c.sheenAlpha = max(p.sheenRoughness * p.sheenRoughness, LEAST_SHEEN_ALPHA);
        c.sheen = fromOutside ? left * p.sheenColor : vec3(0.0);
        const float albedo = sheenAlbedo(max(mu, LEAST_SHEEN_COSINE), c.sheenAlpha);
        c.sheenShare = mean(c.sheen) * albedo;
        left -= largestComponent(c.sheen) * albedo;
    }
    // Metal and dielectric. Stretched facets are given back what narrower round ones are.
    c.interfaceWeight = max(left, 0.0);
    l.albedo = ggxAlbedo(mu, c.facets.alpha.y);
    l.meanAlbedo = ggxMeanAlbedo(c.facets.alpha.y);
    if (isSmooth) l.albedo = l.meanAlbedo = 1.0;
    const float weight = schlickShare(mu, c.facets.alpha.y);
    vec3 ofDielectric = schlick(l.f0, l.f90, weight), ofMetal = schlick(l.baseColor, 1.0, weight);
    if (HAS_IRIDESCENCE) {
        const float cosine = meanCosine(weight);
        ofDielectric = underFilm(l, ofDielectric, cosine, l.f0, l.f90);
        ofMetal = underFilm(l, ofMetal, cosine, l.baseColor, 1.0);
        l.given = underFilm(l, schlick(l.f0, l.f90, MEAN_SCHLICK_WEIGHT), cosine, l.f0, l.f90);
        l.givenMetal = underFilm(l, schlick(l.baseColor, 1.0, MEAN_SCHLICK_WEIGHT), cosine, l.baseColor, 1.0);
    }
    const vec3 dielectric = l.albedo * ofDielectric * givenByDielectric(l);
    const vec3 metal = l.albedo * ofMetal * givenByMetal(l);
    const float opaque = (1.0 - l.metallic) * (1.0 - l.transmission);
    c.diffuse = c.interfaceWeight * opaque * max(1.0 - largestComponent(dielectric), 0.0) * l.baseColor;
    c.diffuseShare = mean(c.diffuse);
    const float facets = c.interfaceWeight * mean(l.metallic * metal + opaque * dielectric +
                                                  vec3((1.0 - l.metallic) * l.transmission));
    if (HAS_THROUGH) {
        const float base = c.interfaceWeight * opaque * max(1.0 - largestComponent(dielectric), 0.0);
        c.through = base * p.diffuseTransmission * p.diffuseTransmissionColor;
        c.throughShare = mean(c.through);
        c.diffuse *= 1.0 - p.diffuseTransmission;
        c.diffuseShare = mean(c.diffuse);
    }
    float sum = c.coatShare + c.sheenShare + c.diffuseShare + max(facets, LEAST_FACET_SHARE);
    if (HAS_THROUGH) {
        sum += c.throughShare;
        c.throughShare /= sum;
    }
    c.coatShare /= sum;
    c.sheenShare /= sum;
    c.diffuseShare /= sum;
    c.principled = l;
}

/// Reflectance of the interface around a volume: Fresnel's equations, from f0 to f90 as they go from
/// normal incidence to 1; total reflection is total.
vec3 reflectanceOfVolume(PrincipledInterface l, float exact, float cosTransmitted) {
    const float r = (l.index - 1.0) / (l.index + 1.0), normal = r * r;
    const vec3 partial = schlick(l.f0, l.f90, max((exact - normal) / (1.0 - normal), 0.0));
    return cosTransmitted == 0.0 ? vec3(1.0) : partial;
}

/// exact, cosTransmitted: as statedLight() has them.
InterfaceLight principledLight(Closures c, float cosine, float exact, float cosTransmitted) {
    const PrincipledInterface l = c.principled;
    const float weight = schlickWeight(cosine);
    const vec3 dielectric = underFilm(l, schlick(l.f0, l.f90, weight), cosine, l.f0, l.f90);
    const vec3 metal = underFilm(l, schlick(l.baseColor, 1.0, weight), cosine, l.baseColor, 1.0);
    const float opaque = (1.0 - l.metallic) * (1.0 - l.transmission);
    InterfaceLight f = InterfaceLight(vec3(0.0), vec3(0.0), cosTransmitted, 1.0);
    f.reflected = l.metallic * metal * givenByMetal(l) + opaque * dielectric * givenByDielectric(l);
    if (SCENE_TRANSMITS) {
        const float share = (1.0 - l.metallic) * l.transmission;
        vec3 mirrored = dielectric;
        float scale = share / l.albedo;
        if (!c.isThin) {
            mirrored = reflectanceOfVolume(l, exact, cosTransmitted);
            // The film is outside, and reflects as much from either side.
            const float above = l.isInside ? cosTransmitted : cosine;
            if (HAS_IRIDESCENCE && cosTransmitted > 0.0) mirrored = underFilm(l, mirrored, above, l.f0, l.f90);
            scale = share;
        }
        f.reflected += scale * mirrored;
        f.transmitted = scale * max(1.0 - largestComponent(mirrored), 0.0) * l.baseColor;
    }
    return f;
}
