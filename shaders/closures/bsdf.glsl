// How materials scatter light. A material is a short list of closures: a recipe says which, with what weights as one
// direction sees them (closures.glsl); here all are evaluated together, and sampled by choosing one. The integrator, light
// sampling and MIS ask for values, densities and lobes (surface_bsdf.glsl), never for what a material is made of.
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
    float pdf;      ///< by solid angle; delta lobes: of no meaning
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
#include "closures/closures.glsl"
#include "closures/base.glsl"
#include "closures/stated.glsl"
#include "closures/principled.glsl"
#include "closures/burley.glsl"
#include "closures/phase.glsl"

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
    if (isPrincipled) principledClosures(c, principledParameters(m), i);
    if (isBurley) burleyClosures(c, m, burleyParameters(m), i);
    return c;
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
        s.weight = chosen > 0.0 ? (transmits ? left.light.transmitted : left.light.reflected) / chosen : vec3(0.0);
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
            if (hasClosure(m, CLOSURE_INTERFACE | CHOSEN_CLOSURES)) s.weight = f.value / max(f.pdf, TINY);
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
