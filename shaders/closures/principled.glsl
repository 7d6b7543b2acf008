// glTF's metallic-roughness material with its extensions: a metal and a dielectric, mixed; on the
// dielectric, specular reflection over diffuse or over transmission; sheen and a clear coat on top.
// docs/theory/surfaces.md, "Principled", has the formulas. Light that microfacets would scatter again is given
// back to the lobe it comes from (Turquin 2019); layers get what those above them leave (albedo scaling).

#include "shared/albedo_fits.h"

/// Each choice between lobes leaves this much to the facets; the one of reflection and transmission excepted.
const float LEAST_FACET_SHARE = 0.015625;

/// What is given back to a lobe whose facets reflect f0 at normal incidence.
vec3 givenBack(vec3 f0, float albedo) { return 1.0 + f0 * (1.0 / albedo - 1.0); }

vec2 facetAlpha(PrincipledParameters p) {
    const float alpha = max(p.roughness * p.roughness, p.leastAlpha);
    if (!sceneHas(FACETS_ARE_TURNED)) return vec2(alpha);
    return vec2(mix(alpha, 1.0, p.anisotropy * p.anisotropy), alpha);
}

/// Shares are of all light; what a layer gets from those above it is in the weights.
void principledClosures(inout Closures c, PrincipledParameters p, Incidence i) {
    PrincipledInterface l;
    const float mu = i.wo.z;
    c.isSmooth = false;
    c.facets = FacetShape(facetAlpha(p), false, false);
    if (sceneHas(FACETS_ARE_TURNED)) c.grain = vec2(cos(p.anisotropyRotation), sin(p.anisotropyRotation));
    const bool isThin = (p.flags & PRINCIPLED_IS_THIN) != 0u;
    l.metallic = p.metallic;
    l.transmission = SCENE_TRANSMITS ? p.transmission : 0.0;
    l.baseColor = p.baseColor;
    c.isThin = !SCENE_REFRACTS || isThin;
    const bool fromOutside = isThin || i.entering;
    l.index = p.ior;
    c.eta = i.entering ? 1.0 / p.ior : p.ior;
    const float r = (p.ior - 1.0) / (p.ior + 1.0);
    l.f0 = min(r * r * p.specularColor, vec3(1.0)) * p.specular;
    l.f90 = p.specular;

    // The coat.
    float left = 1.0;
    if (HAS_COAT) {
        c.coatAlpha = max(p.clearcoatRoughness * p.clearcoatRoughness, LEAST_GGX_ALPHA);
        c.coatNormal = i.coat;
        const float coatMu = sceneHasCoatNormals() ? dot(i.wo, i.coat) : mu;
        const float albedo = ggxAlbedo(coatMu, c.coatAlpha);
        c.coat = fromOutside && coatMu > 0.0 ? p.clearcoat * (1.0 + CLEARCOAT_F0 * (1.0 / albedo - 1.0)) : 0.0;
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
    const float weight = schlickShare(mu, c.facets.alpha.y);
    const vec3 dielectric = l.albedo * schlick(l.f0, l.f90, weight) * givenBack(l.f0, l.albedo);
    const vec3 metal = l.albedo * schlick(l.baseColor, 1.0, weight) * givenBack(l.baseColor, l.albedo);
    const float opaque = (1.0 - l.metallic) * (1.0 - l.transmission);
    c.diffuse = c.interfaceWeight * opaque * max(1.0 - largestComponent(dielectric), 0.0) * l.baseColor;
    c.diffuseShare = mean(c.diffuse);
    const float facets = c.interfaceWeight * mean(l.metallic * metal + opaque * dielectric +
                                                  vec3((1.0 - l.metallic) * l.transmission));
    const float sum = c.coatShare + c.sheenShare + c.diffuseShare + max(facets, LEAST_FACET_SHARE);
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
    const vec3 dielectric = schlick(l.f0, l.f90, weight);
    const float opaque = (1.0 - l.metallic) * (1.0 - l.transmission);
    InterfaceLight f = InterfaceLight(vec3(0.0), vec3(0.0), cosTransmitted, 1.0);
    f.reflected = l.metallic * schlick(l.baseColor, 1.0, weight) * givenBack(l.baseColor, l.albedo) +
                  opaque * dielectric * givenBack(l.f0, l.albedo);
    if (SCENE_TRANSMITS) {
        const float share = (1.0 - l.metallic) * l.transmission;
        vec3 mirrored = dielectric;
        float scale = share / l.albedo;
        if (!c.isThin) {
            mirrored = reflectanceOfVolume(l, exact, cosTransmitted);
            scale = share;
        }
        f.reflected += scale * mirrored;
        f.transmitted = scale * max(1.0 - largestComponent(mirrored), 0.0) * l.baseColor;
    }
    return f;
}
