// The BSDF contract: what the integrator, light sampling and MIS know of how surfaces scatter light.
// They ask for values, densities and lobes, never for a kind of material. A kind of BSDF is a file in
// this folder with its parameters, its evaluation and its sampling in the frame of the shading normal,
// and one line in each of the dispatching functions below.
// docs/estimator.md has the formulas.

/// Value and density of a BSDF for one pair of directions; both 0 where nothing scatters.
struct BsdfValue {
    vec3 value; ///< f |cos|
    float pdf;  ///< density of sampleBsdf(), by solid angle
};

/// A sampled direction. `lobe` is a LOBE_ bit.
struct BsdfSample {
    vec3 direction; ///< unit; world space, or the frame's where a kind samples itself
    vec3 weight;    ///< f |cos| / pdf; 0: the path ends
    float pdf;      ///< by solid angle; delta lobes: of no meaning
    uint lobe;
};

const BsdfValue NO_SCATTERING = BsdfValue(vec3(0.0), 0.0);
const BsdfSample ABSORBED = BsdfSample(vec3(0.0, 0.0, 1.0), vec3(0.0), 0.0, LOBE_DIFFUSE_REFLECTION);

/// Where light comes from, as a BSDF sees it. wo: unit, in the frame of the shading normal, whose z axis
/// is on the side of wo (under the CS184 convention on either); entering: wo is outside of what the
/// surface bounds.
struct Incidence {
    vec3 wo;
    bool entering;
    vec3 coat; ///< unit; the clear coat's normal, in the same frame
};

bool isDelta(uint lobe) { return (lobe & DELTA_LOBES) != 0u; }
bool isTransmission(uint lobe) { return (lobe & TRANSMISSION_LOBES) != 0u; }

#include "bsdf/diffuse.glsl"
#include "bsdf/mirror.glsl"
#include "bsdf/dielectric.glsl"
#include "bsdf/rough_conductor.glsl"
#include "bsdf/ggx.glsl"
#include "bsdf/principled.glsl"
#include "bsdf/facets.glsl"
#include "bsdf/conductor.glsl"
#include "bsdf/facet_dielectric.glsl"
#include "bsdf/plastic.glsl"
#include "bsdf/burley.glsl"

// --- Dispatch: one line for each kind of BSDF in each function ---------------------------------------------------

/// All lobes of a material.
uint lobesOf(Material m) {
    uint lobes = 0u;
    if (isBsdf(m, BSDF_DIFFUSE)) lobes = DIFFUSE_BSDF_LOBES;
    if (isBsdf(m, BSDF_MIRROR)) lobes = MIRROR_BSDF_LOBES;
    if (isBsdf(m, BSDF_REFRACTION)) lobes = REFRACTION_BSDF_LOBES;
    if (isBsdf(m, BSDF_GLASS)) lobes = GLASS_BSDF_LOBES;
    if (isBsdf(m, BSDF_ROUGH_CONDUCTOR)) lobes = ROUGH_CONDUCTOR_BSDF_LOBES;
    if (isBsdf(m, BSDF_PRINCIPLED)) lobes = principledLobes(principledParameters(m));
    if (isBsdf(m, BSDF_CONDUCTOR)) lobes = CONDUCTOR_BSDF_LOBES;
    if (isBsdf(m, BSDF_FACET_CONDUCTOR)) lobes = FACET_CONDUCTOR_BSDF_LOBES;
    if (isBsdf(m, BSDF_FACET_DIELECTRIC)) lobes = FACET_DIELECTRIC_BSDF_LOBES;
    if (isBsdf(m, BSDF_THIN_DIELECTRIC)) lobes = THIN_DIELECTRIC_BSDF_LOBES;
    if (isBsdf(m, BSDF_PLASTIC)) lobes = PLASTIC_BSDF_LOBES;
    if (isBsdf(m, BSDF_FACET_PLASTIC)) lobes = FACET_PLASTIC_BSDF_LOBES;
    if (isBsdf(m, BSDF_BURLEY)) lobes = burleyLobes(burleyParameters(m));
    return lobes;
}

/// All lobes of the scene's materials: known when the kernel is compiled.
uint sceneLobes() {
    return
        (sceneHasBsdf(BSDF_PRINCIPLED) ? scenePrincipledLobes() : 0u) |
        (sceneHasBsdf(BSDF_CONDUCTOR) ? CONDUCTOR_BSDF_LOBES : 0u) |
        (sceneHasBsdf(BSDF_FACET_CONDUCTOR) ? FACET_CONDUCTOR_BSDF_LOBES : 0u) |
        (sceneHasBsdf(BSDF_FACET_DIELECTRIC) ? FACET_DIELECTRIC_BSDF_LOBES : 0u) |
        (sceneHasBsdf(BSDF_THIN_DIELECTRIC) ? THIN_DIELECTRIC_BSDF_LOBES : 0u) |
        (sceneHasBsdf(BSDF_PLASTIC) ? PLASTIC_BSDF_LOBES : 0u) |
        (sceneHasBsdf(BSDF_FACET_PLASTIC) ? FACET_PLASTIC_BSDF_LOBES : 0u) |
        (sceneHasBsdf(BSDF_BURLEY) ? sceneBurleyLobes() : 0u) |
        (sceneHasBsdf(BSDF_DIFFUSE) ? DIFFUSE_BSDF_LOBES : 0u) |
           (sceneHasBsdf(BSDF_MIRROR) ? MIRROR_BSDF_LOBES : 0u) |
           (sceneHasBsdf(BSDF_REFRACTION) ? REFRACTION_BSDF_LOBES : 0u) |
           (sceneHasBsdf(BSDF_GLASS) ? GLASS_BSDF_LOBES : 0u) |
           (sceneHasBsdf(BSDF_ROUGH_CONDUCTOR) ? ROUGH_CONDUCTOR_BSDF_LOBES : 0u);
}

/// Whether the view decides where light goes, as everywhere but under Lambert's law.
bool dependsOnView(Material m) { return !isBsdf(m, BSDF_DIFFUSE); }

/// Whether the surface bounds an inside, which may absorb (include/medium.glsl).
bool boundsVolume(Material m) {
    return isBsdf(m, BSDF_PRINCIPLED) && (principledParameters(m).flags & PRINCIPLED_IS_THIN) == 0u;
}

/// Whether a material's first row of parameters is a colour that base colours multiply.
bool hasBaseColor(Material m) {
    if (isFacetMaterial(m)) return true;
    return isBsdf(m, BSDF_DIFFUSE) || isBsdf(m, BSDF_PRINCIPLED);
}

/// Whether textures change parameters behind the first row, of some material of the scene.
bool hasFurtherParameters() {
    if (sceneHasFacetMaterials()) return true;
    return sceneHasBsdf(BSDF_PRINCIPLED);
}

BsdfValue evaluateLocally(Material m, Incidence i, vec3 wi) {
    if (isBsdf(m, BSDF_DIFFUSE)) return evaluateDiffuse(diffuseParameters(m), i, wi);
    if (isBsdf(m, BSDF_ROUGH_CONDUCTOR))
        return evaluateRoughConductor(roughConductorParameters(m), i, wi);
    if (isBsdf(m, BSDF_PRINCIPLED)) return evaluatePrincipled(principledParameters(m), i, wi);
    if (isBsdf(m, BSDF_FACET_CONDUCTOR))
        return evaluateFacetConductor(conductorParameters(m), i, wi);
    if (isBsdf(m, BSDF_FACET_DIELECTRIC))
        return evaluateFacetDielectric(facetDielectricParameters(m), i, wi);
    if (isBsdf(m, BSDF_PLASTIC)) return evaluatePlastic(plasticParameters(m), i, wi);
    if (isBsdf(m, BSDF_FACET_PLASTIC)) return evaluateFacetPlastic(plasticParameters(m), i, wi);
    if (isBsdf(m, BSDF_BURLEY)) return evaluateBurley(burleyParameters(m), i, wi);
    return NO_SCATTERING; // delta lobes only
}

BsdfSample sampleLocally(Material m, Incidence i, vec3 u) {
    BsdfSample s = ABSORBED;
    if (isBsdf(m, BSDF_DIFFUSE)) s = sampleDiffuse(diffuseParameters(m), i, u);
    if (isBsdf(m, BSDF_MIRROR)) s = sampleMirror(mirrorParameters(m), i, u);
    if (isBsdf(m, BSDF_REFRACTION)) s = sampleRefraction(refractionParameters(m), i, u);
    if (isBsdf(m, BSDF_GLASS)) s = sampleGlass(glassParameters(m), i, u);
    if (isBsdf(m, BSDF_ROUGH_CONDUCTOR)) s = sampleRoughConductor(roughConductorParameters(m), i, u);
    if (isBsdf(m, BSDF_PRINCIPLED)) s = samplePrincipled(principledParameters(m), i, u);
    if (isBsdf(m, BSDF_CONDUCTOR)) s = sampleConductor(conductorParameters(m), i, u);
    if (isBsdf(m, BSDF_FACET_CONDUCTOR)) s = sampleFacetConductor(conductorParameters(m), i, u);
    if (isBsdf(m, BSDF_FACET_DIELECTRIC))
        s = sampleFacetDielectric(facetDielectricParameters(m), i, u);
    if (isBsdf(m, BSDF_THIN_DIELECTRIC))
        s = sampleThinDielectric(thinDielectricParameters(m), i, u);
    if (isBsdf(m, BSDF_PLASTIC)) s = samplePlastic(plasticParameters(m), i, u);
    if (isBsdf(m, BSDF_FACET_PLASTIC)) s = sampleFacetPlastic(plasticParameters(m), i, u);
    if (isBsdf(m, BSDF_BURLEY)) s = sampleBurley(burleyParameters(m), i, u);
    return s;
}

// --- What others ask ------------------------------------------------------------------------------

/// Whether light samples can find light that the surface scatters.
bool scattersIntoManyDirections(uint lobes) { return (lobes & ~DELTA_LOBES) != 0u; }

/// Whether sampleBsdf() takes all three numbers; else either the first two or the last one.
#define TAKES_THREE_NUMBERS(m)                                                                     \
    (isBsdf(m, BSDF_PRINCIPLED) || isBsdf(m, BSDF_FACET_DIELECTRIC) || isBsdf(m, BSDF_BURLEY))

/// Whether two paths that arrive by the same ray may leave by different ones.
bool scattersAtRandom(uint lobes) {
    return lobes != LOBE_DELTA_REFLECTION && lobes != LOBE_DELTA_TRANSMISSION;
}

Incidence incidenceOn(SurfacePoint s, ShadingFrame frame_) {
    const vec3 wo = toLocal(frame_, s.wo);
    const vec3 coat = sceneHasCoatNormals() ? toLocal(frame_, s.coat) : vec3(0.0, 0.0, 1.0);
    return Incidence(wo, entersWhatItBounds(s.outside, wo), coat);
}

/// Light stays on the side of the true surface that its lobe sends it to.
bool isOnItsSide(SurfacePoint s, vec3 wi, bool transmitted) {
    if (!TESTS_GEOMETRIC_SIDE) return true;
    return transmitted ? dot(s.geometric, wi) < 0.0 : isReflected(s, wi);
}

/// What the bumps of a surface let through of light from wi, or none where wi is over the surface but below the horizon
/// of its mapped normal, or the other way round: as a surface of facets whose roughness alpha^2 is an eighth of the
/// squared tangent of the normal's tilt, 1 at most, would mask it (Conty Estevez, Lecocq and Stein 2019, "A
/// Microfacet-Based Shadowing Function to Solve the Bump Terminator Problem"): 2 / (1 + sqrt(1 + alpha^2 tan^2)), times
/// |cos| above and below, as light may graze.
float reliefShadow(Material m, SurfacePoint s, vec3 wi) {
    const uint rules = reliefRules(m);
    if (rules == 0u) return 1.0;
    const vec3 n = unmappedNormal(s), mapped = shadingNormal(s);
    const float c = dot(n, wi), tilt = dot(n, mapped);
    if (c * dot(mapped, wi) <= 0.0) return 0.0;
    if ((rules & MATERIAL_RELIEF_SHADOWS) == 0u) return 1.0;
    const float c2 = c * c, tilt2 = tilt * tilt;
    const float alpha2 = min(0.125 * max(1.0 - tilt2, 0.0) / max(tilt2, TINY), 1.0);
    return 2.0 * abs(c) / (abs(c) + sqrt(c2 + alpha2 * max(1.0 - c2, 0.0)));
}

/// f |cos| and the density for the unit world direction wi, of all lobes but delta ones.
/// s: faced forward.
BsdfValue evaluateBsdf(Material m, SurfacePoint s, vec3 wi) {
    const ShadingFrame frame_ = shadingFrame(s);
    const vec3 local = toLocal(frame_, wi);
    const bool transmitted = local.z < 0.0;
#define LOBES_HERE lobesOf(m)
    const bool possible =
        (transmitted ? (LOBES_HERE & TRANSMISSION_LOBES & ~DELTA_LOBES) != 0u : local.z > 0.0) &&
        isOnItsSide(s, wi, transmitted);
    if (!possible) return NO_SCATTERING;
    BsdfValue f = evaluateLocally(m, incidenceOn(s, frame_), local);
    if (RELIEF_RULES) f.value *= reliefShadow(m, s, wi);
    return f;
}

/// Samples the direction in which light goes on. u, each in [0, 1): x and y for the direction within
/// a lobe, z for the choice of one of several lobes. s: faced forward.
BsdfSample sampleBsdf(Material m, SurfacePoint s, vec3 u) {
    const ShadingFrame frame_ = shadingFrame(s);
    BsdfSample b = sampleLocally(m, incidenceOn(s, frame_), u);
    b.direction = toWorld(frame_, b.direction);
    // Mirrored and refracted directions keep the length of wo but for rounding, which would add up
    // along a path.
    if ((b.lobe & DIFFUSE_LOBES) == 0u) b.direction = unit(b.direction);
    if (!isOnItsSide(s, b.direction, isTransmission(b.lobe))) b.weight = vec3(0.0);
    if (RELIEF_RULES) b.weight *= reliefShadow(m, s, b.direction);
    return b;
}
