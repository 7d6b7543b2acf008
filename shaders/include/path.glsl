// The path tracer as a state machine. Each lane is in one phase; its rays are traced a few steps
// at a time (traverse.glsl), and a lane whose ray is done is served here: it takes in the result,
// works out its next ray, and begins its next sample as soon as a path ends, so that lanes stay
// busy. docs/estimator.md defines what a sample is.

const uint PHASE_FINISHED = 0u;   ///< nothing left to do for this lane
const uint PHASE_PATH = 1u;       ///< tracing a camera or bounce ray
const uint PHASE_SHADOW = 2u;     ///< tracing a ray to a light
const uint PHASE_HEMISPHERE = 3u; ///< tracing a ray of hemisphere sampling
const uint PHASE_DIRECT = 4u;     ///< at a surface, direct light samples left
const uint PHASE_BOUNCE = 5u;     ///< at a surface, direct light done
const uint PHASE_ENDED = 6u;      ///< the path is over
const uint PHASE_NEXT = 7u;       ///< ready for a new sample
const uint PHASE_SUSPENDED = 8u;  ///< a path ray has been put off to the next dispatch

/// All a lane knows. `ray` is what PHASE_PATH, _SHADOW and _HEMISPHERE trace.
uint phase;
Traversal ray;
PixelState pixelState;
uint pixelId;   ///< in the whole picture: names the random numbers
uvec2 pixelAt;  ///< column, row (from the top) in the whole picture
uint bounce;    ///< scatterings so far
vec3 throughput;
vec3 radiance;
bool countsEmission; ///< light that the ray finds adds to the picture ...
float bouncePdf; ///< ... weighted (mis.glsl), by this density of the ray's direction; 0: not weighted
vec3 departureNormal; ///< shading normal of the surface that the ray has left, for that weight
SurfacePoint surface;
Material material;
uint directIndex; ///< direct light samples done at this surface
/// Drawn with the path ray for where it ends. x, y: for the first light sample there; z: for roulette.
vec3 arrivalNumbers;
vec3 directValue; ///< what the ray under way adds if it is free (or, hemisphere, per radiance)
uint rayCount;
#ifdef RICH_MATERIALS
uint medium; ///< that the path ray goes through: the first row of a material, or NO_MEDIUM
#endif

/// Where a sample's path has split into branches (path splitting; docs/estimator.md, "Branches"): at
/// the first surface that scatters at random.
struct SplitPoint {
    SurfacePoint surface;
    vec3 throughput; ///< before scattering
    uint bounce;     ///< 0: has not split
#ifdef RICH_MATERIALS
    uint medium;
#endif
};
SplitPoint splitPoint;
uint branchesLeft; ///< that have not begun

#include "include/camera_sample.glsl"

/// Blocks of random numbers that branches take: none of those before paths split.
const uint BRANCH_BLOCKS = 0x80000000u;

/// Direct light samples at a surface: directions of hemisphere sampling, then samples of lights.
uint directSamples() { return frame.hemisphereSamples + frame.lightSamples; }

/// The number of the sample under way, or the next one, of this pixel.
uint sampleIndex() { return frame.firstSample + pixelState.count + pixelState.rejected; }

/// Block 0 of a path ray, `bounce` of its path, is for the ray itself and for what happens where it ends;
/// further light samples there take the blocks after it.
uvec4 randomWords(uint slot) {
    uint sample_ = sampleIndex(), block = bounce * (1u + directSamples()) + slot;
    if (SPLITS && splitPoint.bounce != 0u) {
        sample_ = sample_ * frame.branches + frame.branches - 1u - branchesLeft;
        block |= BRANCH_BLOCKS;
    }
    return randomWords(pixelId, sample_, block, frame.seed);
}

#ifdef RICH_MATERIALS
/// Blocks of random numbers that choices between reflection and transmission take.
const uint CHOICE_BLOCKS = 0x40000000u;

/// The third number of a bounce: of a block of its own, and not spread evenly.
float sideNumber() {
    uint sample_ = sampleIndex(), block = bounce | CHOICE_BLOCKS;
    if (SPLITS && splitPoint.bounce != 0u) {
        sample_ = sample_ * frame.branches + frame.branches - 1u - branchesLeft;
        block |= BRANCH_BLOCKS;
    }
    return unitFloats(pcg4d(uvec4(pixelId, sample_, block, frame.seed))).x;
}

#include "pass_through.glsl"
#else
/// The material of a surface; a scene of the smaller modules has no textures.
Material materialAt(SurfacePoint s) { return fetchMaterial(s.material); }
#endif

/// Asks for a ray. Rays are prepared in one place, startRay() (docs/kernel.md, "What llvmpipe does").
void trace(uint newPhase, vec3 origin, vec3 direction, float tMin, float tMax, uint skipPrimitive) {
    phase = newPhase;
    ray.origin = origin;
    ray.direction = direction;
    ray.tMin = tMin;
    ray.tMax = tMax;
    ray.skipPrimitive = skipPrimitive;
#ifdef RICH_MATERIALS
    ray.passed = NO_PRIMITIVE;
    rayEnd = tMax;
#endif
}

bool isTracing(uint p) {
    return p == PHASE_PATH || p == PHASE_SHADOW ||
           (DIRECT_LIGHT == DIRECT_HEMISPHERE && p == PHASE_HEMISPHERE);
}

void startRay() {
    if (!isTracing(phase) || traversing(ray)) return;
    ray.anyHit = phase == PHASE_SHADOW && !HAS_ALPHA;
    startTraversal(ray);
    ++rayCount;
}

// --- Arrivals ----------------------------------------------------------------------------------

vec3 emissionAt(SurfacePoint s, Material m) {
    if (!HAS_EMISSION) return vec3(0.0);
    return emitsBothSides(m) || s.outside ? emissionOf(m) : vec3(0.0);
}

/// The share of the light that the path ray has found that is this ray's, and not light samples'.
float foundShare(FoundSky sky) {
    if (MIS_LOBES == 0u || bouncePdf == 0.0) return 1.0;
    return foundLightWeight(ray, departureNormal, sky, bouncePdf);
}

void finishShadowRay() {
    if (ray.hitPrimitive == NO_PRIMITIVE) radiance += throughput * directValue;
    phase = PHASE_DIRECT;
}

void finishHemisphereRay() {
    const bool hit = ray.hitPrimitive != NO_PRIMITIVE;
    vec3 found = BOUNCES_FIND_ALL_LIGHT ? skyFrom(ray.direction, ray.direction).radiance : vec3(0.0);
    if (hit) {
        const SurfacePoint s = surfaceAt(ray);
        found = emissionAt(s, materialAt(s));
    }
#ifdef RICH_MATERIALS
    found *= transmittance(mediumBeyond(surface, material, medium, isBehind(surface, ray.direction)),
                           ray.tMax);
#endif
    radiance += throughput * directValue * found;
    phase = PHASE_DIRECT;
}

/// A path ray is done: takes in the light that it has found and sets up the surface for scattering.
void arrive() {
    const bool hit = ray.hitPrimitive != NO_PRIMITIVE;
    phase = PHASE_ENDED;
    FoundSky sky = NO_SKY;
    if (!hit) sky = skyFrom(departureNormal, ray.direction);
    const float share = foundShare(sky);
#ifdef RICH_MATERIALS
    throughput *= transmittance(medium, hit ? ray.tMax : INFINITE_DISTANCE);
#endif
    if (!hit) {
        const bool counts = countsEmission || AMBIENT_BY_BOUNCES && bounce >= frame.minBounce;
        if (counts && (bounce > 0u || HAS_BACKDROP) && BOUNCES_FIND_ALL_LIGHT)
            radiance += throughput * sky.radiance * share;
        return;
    }
    surface = surfaceAt(ray);
    if (INTEGRATOR == INTEGRATOR_NORMALS) {
        radiance = 0.5 * shadingNormal(surface) + 0.5;
        return;
    }
#ifdef RICH_MATERIALS
    vec3 mapped;
    material = materialAt(surface, mapped);
#else
    material = fetchMaterial(surface.material);
#endif
    if (countsEmission) radiance += throughput * emissionAt(surface, material) * share;
    faceForward(surface);
#ifdef RICH_MATERIALS
    applyNormalMap(surface, mapped);
#endif
    ++bounce;
    if (bounce > frame.maxBounces) return;
    if (ROULETTE == ROULETTE_FIXED) {
        if (arrivalNumbers.z < frame.terminationProbability) return;
        throughput /= 1.0 - frame.terminationProbability;
    }
    const bool direct =
        scattersIntoManyDirections(lobesOf(material)) && bounce >= frame.minBounce;
    directIndex = direct ? 0u : directSamples();
    phase = PHASE_DIRECT;
}

// --- Departures --------------------------------------------------------------------------------

/// A direction of hemisphere sampling as a light sample whose light is not known yet.
LightSample hemisphereSample(vec2 u) {
#ifdef RICH_MATERIALS
    if (isLitFromBothSides(lobesOf(material))) {
        const float side = takesOtherSide(u) ? -1.0 : 1.0;
        const vec3 w = side * toWorld(makeFrame(shadingNormal(surface)), sampleUniformHemisphere(u));
        return LightSample(w, true, w, vec3(4.0 * PI / float(frame.hemisphereSamples)), 0.0);
    }
#endif
    const vec3 w = toWorld(makeFrame(shadingNormal(surface)), sampleUniformHemisphere(u));
    return LightSample(w, true, w, vec3(2.0 * PI / float(frame.hemisphereSamples)), 0.0);
}

/// A sample of one of the lights, with the probability of its choice and its share of the direct light in
/// its radiance and density.
LightSample lightSample(vec2 u, uint index) {
#ifdef RICH_MATERIALS
    SurfacePoint lit = surface;
    const bool bothSides = isLitFromBothSides(lobesOf(material));
    if (bothSides && takesOtherSide(u)) lit = otherSide(surface);
    const PickedLight picked = pickLight(litPoint(lit), shadingNormal(lit), index, u);
    LightSample light = sampleLight(lit, picked.light, picked.u);
    if (bothSides) {
        light.radiance *= dot(shadingNormal(lit), light.direction) > 0.0 ? 2.0 : 0.0;
        light.inversePdf *= 2.0;
    }
#else
    const PickedLight picked = pickLight(litPoint(surface), shadingNormal(surface), index, u);
    LightSample light = sampleLight(surface, picked.light, picked.u);
#endif
    const float perProbability =
        picked.probability > 0.0 ? 1.0 / picked.probability : 0.0;
    light.radiance *= perProbability * lightSampleShare(index);
    light.inversePdf *= perProbability;
    return light;
}

/// Starts the ray of a direct light sample, if it can contribute.
void traceDirectSample(LightSample light, bool hemisphere) {
    const BsdfValue f = evaluateBsdf(material, surface, light.direction);
    directValue = f.value * light.radiance;
    if (!(dot(directValue, vec3(1.0)) > 0.0)) return;
    if (combines(lobesOf(material))) {
        const float pdf = bouncePdfWithGap(surface, lobesOf(material), f.pdf, light.direction);
        directValue *= lightSampleWeight(light.inversePdf, pdf);
    }
#ifdef RICH_MATERIALS
    const bool transmitted = isBehind(surface, light.direction);
#else
    const bool transmitted = false;
#endif
    const vec3 origin = leave(surface, light.direction, transmitted);
#ifdef RICH_MATERIALS
    // What the ray of hemisphere sampling goes through is known when it has arrived.
    if (HAS_ABSORPTION && !hemisphere)
        directValue *=
            transmittance(mediumBeyond(surface, material, medium, transmitted),
                          light.infinite ? INFINITE_DISTANCE : length(light.target - origin));
#endif
    trace(hemisphere ? PHASE_HEMISPHERE : PHASE_SHADOW, origin,
          light.infinite ? light.direction : light.target - origin, 0.0,
          light.infinite ? INFINITE_DISTANCE : 1.0, skipOnLeaving(surface, transmitted));
}

/// One direct light sample.
void sampleDirect() {
    const uint index = directIndex++;
    vec2 u = arrivalNumbers.xy;
    if (LIGHT_NUMBERS == LIGHT_NUMBERS_FIRST && index > 0u)
        u = unitFloats(randomWords(1u + index)).xy;
    const bool hemisphere = DIRECT_LIGHT == DIRECT_HEMISPHERE && index < frame.hemisphereSamples;
    LightSample light;
    if (hemisphere) light = hemisphereSample(u);
    else light = lightSample(u, DIRECT_LIGHT == DIRECT_HEMISPHERE ? index - frame.hemisphereSamples
                                                                  : index);
    traceDirectSample(light, hemisphere);
}

/// Whether light found by the bounce from here, from one of these lobes, adds to the picture.
bool emissionCounts(uint lobes) {
    return bounce >= frame.minBounce &&
           (isDelta(lobes) || combines(lobes) ||
            DIRECT_LIGHT == DIRECT_BSDF && BOUNCES_FIND_ALL_LIGHT);
}

/// All branches are of one weight. From here on `radiance` is their sum, until finishSample.
void splitPath() {
#ifdef RICH_MATERIALS
    splitPoint = SplitPoint(surface, throughput, bounce, medium);
#else
    splitPoint = SplitPoint(surface, throughput, bounce);
#endif
    branchesLeft = frame.branches - 1u;
    radiance *= float(frame.branches);
}

/// Goes back to where the path split, with the next branch.
void nextBranch() {
    --branchesLeft;
    surface = splitPoint.surface;
    material = materialAt(surface);
    throughput = splitPoint.throughput;
    bounce = splitPoint.bounce;
#ifdef RICH_MATERIALS
    medium = splitPoint.medium;
#endif
    phase = PHASE_BOUNCE;
}

/// No bounce from here would be traced.
bool endsHere() {
    return bounce == frame.maxBounces && !AMBIENT_BY_BOUNCES && !emissionCounts(lobesOf(material));
}

/// u: as sampleBsdf() takes it; roulette: for the path's end.
void scatter(vec3 u, float roulette) {
    phase = PHASE_ENDED;
    float mixtureWeight;
    const BsdfSample b = sampleBsdfOrGap(material, surface, u, mixtureWeight);
    throughput *= b.weight;
    const float largest = largestComponent(throughput);
    if (!(largest > 0.0)) return;
    if (ROULETTE == ROULETTE_THROUGHPUT && bounce >= ROULETTE_THROUGHPUT_START) {
        const float q = min(ROULETTE_MAX_CONTINUE, ROULETTE_BOLDNESS * largest);
        if (roulette >= q) return;
        throughput *= 1.0 / q;
    }
    if (GAP_PROPOSAL) throughput *= mixtureWeight;
    const bool transmitted = isTransmission(b.lobe);
    countsEmission = emissionCounts(b.lobe);
    bouncePdf = combines(b.lobe) ? max(b.pdf, TINY) : 0.0;
    departureNormal = shadingNormal(surface);
#ifdef RICH_MATERIALS
    if (isLitFromBothSides(lobesOf(material))) { // as light samples of that side are taken
        bouncePdf *= 2.0;
        departureNormal = transmitted ? -departureNormal : departureNormal;
    }
    medium = mediumBeyond(surface, material, medium, transmitted);
#endif
    trace(PHASE_PATH, leave(surface, b.direction, transmitted), b.direction, 0.0, INFINITE_DISTANCE,
          skipOnLeaving(surface, transmitted));
}

void beginSample() {
    bounce = 0u;
    throughput = vec3(1.0);
    radiance = vec3(0.0);
    countsEmission = frame.minBounce == 0u;
    bouncePdf = 0.0;
#ifdef RICH_MATERIALS
    medium = NO_MEDIUM;
#endif
    splitPoint.bounce = 0u;
    branchesLeft = 0u;
}

void startCameraRay(vec2 u) {
    const CameraRay c = cameraRayOfSample(pixelAt, pixelId, sampleIndex(), u);
    trace(PHASE_PATH, c.origin, c.direction, c.tMin, c.tMax, NO_PRIMITIVE);
}

/// Starts the next path ray: of a new sample (PHASE_NEXT), or the bounce (PHASE_BOUNCE). Both draw
/// their numbers in one place (docs/kernel.md, "What llvmpipe does"). A bounce may end the path.
void depart() {
    const bool begins = phase == PHASE_NEXT;
    if (begins) beginSample();
    else if (SPLITS && splitPoint.bounce == 0u && scattersAtRandom(lobesOf(material))) splitPath();
    const uvec4 words = randomWords(0u);
    const vec4 u = unitFloats(words);
    arrivalNumbers = vec3(u.xy, leftOver(words));
    // Most kinds of BSDF take either the two numbers within a lobe or the one that chooses a lobe, so that
    // both may be the same (host/kernel/kernel_features.cpp asserts it).
    if (begins) startCameraRay(u.zw);
#ifdef RICH_MATERIALS
    else if (SCATTERS_THROUGH && INTEGRATOR == INTEGRATOR_PATH)
        scatter(vec3(u.zw, TAKES_THREE_NUMBERS(material) ? sideNumber() : u.z), arrivalNumbers.z);
#endif
    else if (INTEGRATOR == INTEGRATOR_PATH) scatter(u.zwz, arrivalNumbers.z);
}

/// The path is over, but not the sample.
bool branchIsOver() { return SPLITS && phase == PHASE_ENDED && branchesLeft > 0u; }

void finishSample() {
    if (SPLITS && splitPoint.bounce != 0u) radiance /= float(frame.branches);
    addSample(pixelState, radiance);
    phase = PHASE_NEXT;
}

// --- Service -------------------------------------------------------------------------------------

/// Takes in the finished ray. What is next: a shadow ray, which it asks for; a bounce (PHASE_BOUNCE), or
/// another sample (PHASE_NEXT), both by depart().
void followPath() {
#ifdef RICH_MATERIALS
    if (HAS_ALPHA && passesThrough()) return;
#endif
    if (phase == PHASE_SHADOW) finishShadowRay();
    else if (DIRECT_LIGHT == DIRECT_HEMISPHERE && phase == PHASE_HEMISPHERE) finishHemisphereRay();
    else if (phase == PHASE_PATH) arrive();

    if (INTEGRATOR == INTEGRATOR_PATH) {
        if (phase == PHASE_DIRECT && directIndex < directSamples()) sampleDirect();
        if (phase == PHASE_DIRECT && directIndex >= directSamples())
            phase = endsHere() ? PHASE_ENDED : PHASE_BOUNCE;
        if (branchIsOver()) nextBranch();
    }
    if (phase == PHASE_ENDED && !branchIsOver()) finishSample();
}
