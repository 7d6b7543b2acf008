// How materials scatter light. A material is a short list of closures, with weights as one direction sees them, which
// follow from its parameters, or by a recipe (principled.glsl, burley.glsl); all are evaluated together, and sampled by
// choosing one. The integrator, light sampling and MIS ask for values, densities and lobes (surface_bsdf.glsl), never for
// what a material is made of.
// docs/theory/surfaces.md has the formulas, docs/theory/extending.md says how to add a closure.

/// Value and density of a BSDF for one pair of directions; both 0 where nothing scatters.
struct BsdfValue {
    vec3 value; ///< f |cos|
    float pdf;  ///< density of sampleBsdf(), by solid angle
};

/// A sampled direction. `lobe` is a LOBE_ bit.
struct BsdfSample {
    vec3 direction; ///< unit; world space, inside this folder the frame of the shading normal
    vec3 weight;    ///< f |cos| / pdf; 0: the path ends
    float pdf;      ///< by solid angle; delta lobes: the probability of their choice
    uint lobe;
};

const BsdfValue NO_SCATTERING = BsdfValue(vec3(0.0), 0.0);
const BsdfSample ABSORBED = BsdfSample(vec3(0.0, 0.0, 1.0), vec3(0.0), 0.0, LOBE_DIFFUSE_REFLECTION);

bool isDelta(uint lobe) { return (lobe & DELTA_LOBES) != 0u; }
bool isTransmission(uint lobe) { return (lobe & TRANSMISSION_LOBES) != 0u; }

#include "closures/fresnel.glsl"
#include "closures/facets.glsl"
#include "closures/sheen.glsl"
#include "closures/film.glsl"

// --- A material as one direction sees it ----------------------------------------------------------
// Its closures with their weights, and the probabilities with which samples choose them. Directions are unit vectors in the
// frame of the shading normal.

const bool SCENE_REFRACTS = (CLOSURES & (INTERFACE_REFRACTS)) != 0u;
const bool SCENE_TRANSMITS = (CLOSURES & (INTERFACE_REFRACTS | INTERFACE_IS_THIN)) != 0u;
const bool HAS_COAT = (CLOSURES & (CLOSURE_COAT)) != 0u;
/// Whether some base scatters to the other side in glTF's model.
const bool HAS_THROUGH = (CLOSURES & (LOBE_DIFFUSE_TRANSMISSION)) != 0u;
const bool HAS_SHEEN = (CLOSURES & (CLOSURE_SHEEN)) != 0u;
/// Bits of materials of which samples choose one of several closures.
const uint CHOSEN_CLOSURES = CLOSURE_LAYERS | CLOSURE_COAT | CLOSURE_SHEEN | LOBE_DIFFUSE_TRANSMISSION |
                             RECIPE_PRINCIPLED | RECIPE_BURLEY;
const bool SAMPLES_CHOOSE = (CLOSURES & (CHOSEN_CLOSURES)) != 0u;
/// Whether coats of some materials have normals of their own: DETAIL_COAT_HAS_NORMAL.
bool sceneHasCoatNormals() {
    const uint maps = 1u << TEXTURE_NORMAL | 1u << TEXTURE_CLEARCOAT_NORMAL;
    return HAS_COAT && sceneHas(RECIPE_PRINCIPLED) && (TEXTURE_SLOTS & maps) != 0u;
}

/// Where light comes from, as a material sees it. wo: unit, in the frame of the shading normal, whose z axis
/// is on the side of wo (without FACES_FORWARD on either); entering: wo is outside of what the
/// surface bounds.
struct Incidence {
    vec3 wo;
    bool entering;
    vec3 coat; ///< unit; the clear coat's normal, in the same frame
};

/// What the interface of glTF's model is made of.
struct PrincipledInterface {
    float metallic, transmission; ///< transmission: of the dielectric
    vec3 baseColor;
    vec3 f0; ///< of the dielectric
    float f90;
    float index;  ///< inside over outside
    float spread; ///< half of what blue light's index has more than red light's
    bool isInside; ///< of the volume
    float film;    ///< strength of interference in a thin film
    float filmIor, filmThickness; ///< nanometres
    float albedo, meanAlbedo; ///< ggxAlbedo() and ggxMeanAlbedo() of the microfacets
    vec3 given, givenMetal; ///< under a film, mean reflectances by which light that facets scatter again is given back
};

/// What the interface and the base of Burley's model are made of.
struct BurleyInterface {
    bool isInside; ///< of a volume: only its interface is seen
    float clear;   ///< weight of the interface without a base
    vec3 tint;     ///< hue of the base colour
};

struct Closures {
    vec3 wo;
    float eta;        ///< index on the side of wo over that on the other
    bool isSmooth;    ///< the interface is a plane
    bool isThin;      ///< what is transmitted goes straight through
    FacetShape facets;
    FacetShape thinFacets; ///< of what a sheet of Burley's model transmits
    vec2 grain;            ///< cosine and sine of the angle from the tangent to the facets' first direction
    float interfaceWeight; ///< what the layers above leave to the interface
    vec3 diffuse;          ///< albedo of the base, times what reaches it and leaves it towards wo
    vec3 through;          ///< the same of diffuse transmission
    vec3 sheen;
    float sheenAlpha;
    float coat; ///< weight
    float coatAlpha;
    vec3 coatNormal;
    float diffuseShare, throughShare, sheenShare, coatShare; ///< probabilities; the rest is the interface's
    PrincipledInterface principled;
    BurleyInterface burley;
};

float interfaceShare(Closures c) { return max(1.0 - c.diffuseShare - c.throughShare - c.sheenShare - c.coatShare, 0.0); }

/// What the interface does with light at one of its facets, or the plane (interface.glsl).
struct InterfaceLight {
    vec3 reflected, transmitted;
    float cosTransmitted; ///< 0 in total reflection
    float reflects;       ///< probability with which samples are reflected
};

#include "closures/base.glsl"
#include "closures/principled.glsl"
#include "closures/burley.glsl"
#include "closures/phase.glsl"
#include "closures/interface.glsl"

/// All lobes of a material.
uint lobesOf(Material m) {
    const bool allHaveTheSame = ((CLOSURES ^ CLOSURES_OF_ALL) & LOBE_MASK) == 0u;
    return allHaveTheSame ? CLOSURES & LOBE_MASK : m.header.w & LOBE_MASK;
}

/// All lobes of the scene's materials: known when the kernel is compiled.
uint sceneLobes() { return CLOSURES & LOBE_MASK; }

/// Whether the view decides where light goes, as everywhere but under Lambert's law.
bool dependsOnView(Material m) { return hasClosure(m, CLOSURE_INTERFACE); }

/// Whether the surface bounds an inside, which may absorb (include/medium.glsl).
bool boundsVolume(Material m) {
    return hasClosure(m, RECIPE_PRINCIPLED) && principledParameters(m).spread >= 0.0;
}

// --- All closures together ------------------------------------------------------------------------

/// The base and the interface of a material without a recipe, as wo sees them.
void stateClosures(inout Closures c, Material m, StatedParameters p, Incidence i) {
    const bool hasBase = hasClosure(m, CLOSURE_BASE);
    c.isSmooth = hasClosure(m, INTERFACE_IS_SMOOTH);
    c.isThin = hasClosure(m, INTERFACE_IS_THIN);
    const float ratio = p.index[INDEX_RATIO];
    c.eta = i.entering || c.isThin || hasBase ? 1.0 / ratio : ratio; // an opaque base has no inside
    const bool isRefracting = hasClosure(m, INTERFACE_IS_DIELECTRIC) && !hasBase;
    const float least = max(LEAST_GGX_ALPHA, isRefracting ? p.index[INDEX_LEAST_ALPHA] : 0.0);
    c.facets = facetShape(max(vec2(p.alphaX, p.alphaY), vec2(least)), m.header.w);
    c.diffuse = p.color;
    c.diffuseShare = hasBase ? 1.0 : 0.0;
    if (sceneHas(CLOSURE_LAYERS) && hasClosure(m, CLOSURE_LAYERS)) {
        // By what the interface reflects towards wo and by the colours of both.
        const float through = throughInterface(m, p, i.wo.z);
        const float top = (1.0 - through) * mean(p.edge), base = through * mean(p.color);
        c.diffuse = through * albedoUnderInterface(m, p);
        c.diffuseShare = top > 0.0 ? base / (top + base) : 1.0;
    }
}

Closures closuresOf(Material m, Incidence i) {
    Closures c;
    c.wo = i.wo;
    c.eta = 1.0;
    c.isSmooth = c.isThin = false;
    c.grain = vec2(1.0, 0.0);
    c.coatNormal = vec3(0.0, 0.0, 1.0);
    c.interfaceWeight = 1.0;
    c.diffuse = c.through = c.sheen = vec3(0.0);
    c.diffuseShare = c.throughShare = c.sheenShare = c.coatShare = c.coat = 0.0;
    const bool isPrincipled = hasClosure(m, RECIPE_PRINCIPLED), isBurley = hasClosure(m, RECIPE_BURLEY);
    if (!isPrincipled && !isBurley) stateClosures(c, m, statedParameters(m), i);
    if (isPrincipled) principledClosures(c, principledParameters(m), i, hasClosure(m, INTERFACE_IS_SMOOTH));
    if (isBurley) burleyClosures(c, m, burleyParameters(m), i);
    return c;
}

/// The base, diffusely reflected or transmitted, and sheen; f cos.
vec3 diffuseValue(Material m, Closures c, vec3 wi) {
    const float lambert = abs(wi.z) * INV_PI;
    const bool isPrincipled = hasClosure(m, RECIPE_PRINCIPLED), isBurley = hasClosure(m, RECIPE_BURLEY);
    float shape = 1.0;
    if (!isPrincipled && !isBurley) shape = statedDiffuse(m, statedParameters(m), wi);
    if (isBurley) shape = burleyDiffuse(burleyParameters(m), c.wo, wi);
    vec3 value = c.diffuse * (shape * lambert);
    if (HAS_SHEEN) {
        float sheen = 0.0;
        if (isPrincipled) sheen = sheenValue(c.sheenAlpha, c.wo, wi);
        if (isBurley) sheen = schlickWeight(dot(wi, unit(c.wo + wi)));
        value += c.sheen * (sheen * wi.z);
    }
    if (wi.z < 0.0) value = c.through * lambert;
    return value;
}

/// All but planes. h: the facets' normal, along the grain; their direction from wo is wi.
BsdfValue evaluateClosures(Material m, Closures c, vec3 wi, vec3 h) {
    const float lambert = abs(wi.z) * INV_PI;
    BsdfValue f = NO_SCATTERING;
    f.value = diffuseValue(m, c, wi) * (hasClosure(m, CLOSURE_BASE) ? 1.0 : 0.0);
    f.pdf = (wi.z < 0.0 ? c.throughShare : c.diffuseShare) * lambert;
    if (HAS_FACETS && hasClosure(m, CLOSURE_INTERFACE)) {
        BsdfValue facets;
        if (disperses(m, c))
            facets = evaluateDispersed(m, c, alongGrain(c, c.wo), alongGrain(c, wi));
        else
            facets = evaluateFacets(m, c, alongGrain(c, c.wo), alongGrain(c, wi), h);
        f.value += c.interfaceWeight * facets.value;
        f.pdf += interfaceShare(c) * facets.pdf;
    }
    const bool reflects = wi.z >= 0.0;
    if (HAS_SHEEN && reflects) f.pdf += c.sheenShare * (0.5 * INV_PI);
    if (HAS_COAT && reflects && c.coat > 0.0) {
        BsdfValue coat = NO_SCATTERING;
        if (hasClosure(m, RECIPE_PRINCIPLED)) coat = evaluateCoat(c, wi);
        if (hasClosure(m, RECIPE_BURLEY)) coat = burleyCoat(c, wi);
        f.value += coat.value;
        f.pdf += c.coatShare * coat.pdf;
    }
    return f;
}

/// Whether materials with an interface show it to light from there; a base alone shows both sides.
bool isMet(Material m, Incidence i) { return i.wo.z > 0.0 || !hasClosure(m, CLOSURE_INTERFACE); }

BsdfValue evaluateLocally(Material m, Incidence i, vec3 wi) {
    const Closures c = closuresOf(m, i);
    vec3 h = vec3(0.0, 0.0, 1.0);
    if (HAS_FACETS) h = normalBetween(c, alongGrain(c, i.wo), alongGrain(c, wi));
    BsdfValue f = evaluateClosures(m, c, wi, h);
    if (!isMet(m, i) || wi.z == 0.0) f = NO_SCATTERING;
    return f;
}

/// Which closure a sample is of.
struct ClosureChoice {
    bool diffuse, through, sheen, coat; ///< through: of those that are diffuse; none: the interface's
    vec2 rest;                          ///< what is left of the numbers, uniform in [0, 1)
};

/// The first number chooses, and what is left of it is used again.
ClosureChoice chooseClosure(Material m, Closures c, vec2 u) {
    if (!SAMPLES_CHOOSE) return ClosureChoice(hasClosure(m, CLOSURE_BASE), false, false, false, u);
    const float diffuseEnd = c.diffuseShare, throughEnd = diffuseEnd + c.throughShare;
    const float sheenEnd = throughEnd + c.sheenShare, coatEnd = sheenEnd + c.coatShare;
    ClosureChoice choice;
    choice.diffuse = u.x < throughEnd;
    choice.through = choice.diffuse && u.x >= diffuseEnd;
    choice.sheen = HAS_SHEEN && !choice.diffuse && u.x < sheenEnd;
    choice.coat = HAS_COAT && !choice.diffuse && !choice.sheen && u.x < coatEnd;
    const float from = choice.diffuse ? (choice.through ? diffuseEnd : 0.0)
                                      : (choice.sheen ? throughEnd : (choice.coat ? sheenEnd : coatEnd));
    const float to = choice.diffuse ? (choice.through ? throughEnd : diffuseEnd)
                                    : (choice.sheen ? sheenEnd : (choice.coat ? coatEnd : 1.0));
    choice.rest = vec2(clamp((u.x - from) / (to - from), 0.0, 1.0 - UNIT_ROUNDOFF), u.y);
    return choice;
}

/// u.x chooses the closure, and what is left of it and u.y the direction; u.z chooses between reflection and
/// transmission.
BsdfSample sampleLocally(Material m, Incidence i, vec3 u) {
    BsdfSample s = ABSORBED;
    const Closures c = closuresOf(m, i);
    const ClosureChoice choice = chooseClosure(m, c, u.xy);
    if (sceneHas(CLOSURE_BASE)) s.direction = sampleCosineHemisphere(choice.rest);
    if (!sceneHas(CLOSURE_INTERFACE) && !SAMPLES_CHOOSE) { // each is a base alone
        s.pdf = s.direction.z * INV_PI;
        s.weight = c.diffuse;
        return s;
    }
    if (choice.through) s.direction.z = -s.direction.z;
    if (HAS_SHEEN && choice.sheen) s.direction = sampleUniformHemisphere(choice.rest);
    Closures leaves = c;
    float side = u.z;
    if (disperses(m, c)) {
        const float channel = min(floor(3.0 * side), 2.0);
        leaves = ofChannel(c, uint(int(channel)));
        side = clamp(3.0 * side - channel, 0.0, 1.0 - UNIT_ROUNDOFF);
    }
    const LeftFacet left = leaveFacet(m, leaves, choice.coat, choice.rest, side);
    const bool ofFacets = !choice.diffuse && !choice.sheen;
    const bool ofInterface = ofFacets && !choice.coat;
    if (ofFacets) s.direction = left.direction;
    const bool transmits = choice.through || ofInterface && left.transmits;
    const bool isGlossy = (lobesOf(m) & GLOSSY_LOBES) != 0u;
    s.lobe = isGlossy ? (transmits ? LOBE_GLOSSY_TRANSMISSION : LOBE_GLOSSY_REFLECTION) : LOBE_DIFFUSE_REFLECTION;
    if (HAS_THROUGH && choice.through && !isGlossy) s.lobe = LOBE_DIFFUSE_TRANSMISSION;
    const bool isPlane = sceneHas(INTERFACE_IS_SMOOTH) && ofInterface && c.isSmooth;
    if (isPlane) {
        s.lobe = transmits ? LOBE_DELTA_TRANSMISSION : LOBE_DELTA_REFLECTION;
        const float chosen = interfaceShare(c) * (transmits ? 1.0 - left.light.reflects : left.light.reflects);
        s.pdf = chosen;
        s.weight = chosen > 0.0 ? (transmits ? left.light.transmitted : left.light.reflected) * (1.0 / chosen) : vec3(0.0);
    }
    if (!isPlane) {
        // A base alone; else all that may send light there.
        s.pdf = s.direction.z * INV_PI;
        s.weight = c.diffuse;
        if (HAS_FACETS || SAMPLES_CHOOSE) {
            vec3 h = left.h;
            if (HAS_FACETS && !ofInterface) h = normalBetween(c, alongGrain(c, c.wo), alongGrain(c, s.direction));
            const BsdfValue f = evaluateClosures(m, c, s.direction, h);
            s.pdf = f.pdf;
            if (hasClosure(m, CLOSURE_INTERFACE | CHOSEN_CLOSURES)) s.weight = f.value * (1.0 / max(f.pdf, TINY));
        }
    }
    // Below the surface that it should be above, or the other way round.
    const bool isOnSide = transmits ? s.direction.z < 0.0 : s.direction.z > 0.0;
    const bool isLost = !isMet(m, i) || !isOnSide || ofFacets && !left.isPossible;
    if (isPlane ? FACES_FORWARD && !(i.wo.z > 0.0) : isLost) s.weight = vec3(0.0);
    if (MOST_OTHERS > 0u && isLost) s.pdf = 0.0; // which tells it from what is black
    return s;
}

#include "closures/surface_bsdf.glsl"
