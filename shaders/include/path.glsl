// The path tracer as a state machine. Each lane is in one phase; its rays are traced a few steps
// at a time (traverse.glsl), and a lane whose ray is done is served here: it takes in the result,
// works out its next ray, and begins its next sample as soon as a path ends, so that lanes stay
// busy. docs/estimator.md defines what a sample is.

#include "include/path_state.glsl"

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

/// What a material is at the point that the finished ray asks for: where it has met a surface, or, a shadow ray that has
/// met none, where the light sample has gone. One lookup for all, since every lane takes part in each (docs/kernel.md).
MaterialAtPoint found;

MaterialPoint askedPoint() {
    if (ray.hitPrimitive != NO_PRIMITIVE) return materialPoint(ray.hitPrimitive, vec2(ray.b1, ray.b2));
    if (emissionHasFactors() && phase == PHASE_SHADOW) return sampledEmitter;
    return MaterialPoint(0u, NO_PRIMITIVE, vec2(0.0));
}

void finishShadowRay() {
    if (emissionHasFactors() && sampledEmitter.primitive != NO_PRIMITIVE)
        directValue *= emissionFactorOf(found);
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
    found *= transmittance(mediumBeyond(surface, material, medium, isBehind(surface, ray.direction)),
                           ray.tMax);
    radiance += throughput * directValue * found;
    phase = PHASE_DIRECT;
}

/// Adds the light of the sky that the path ray has found. share: of it that is this ray's (foundShare()).
void takeInSky(FoundSky sky, float share) {
    const bool counts = countsEmission || AMBIENT_BY_BOUNCES && bounce >= frame.minBounce;
    if (counts && (bounce > 0u || HAS_BACKDROP) && BOUNCES_FIND_ALL_LIGHT)
        radiance += throughput * sky.radiance * share;
}

/// A path ray is done: takes in the light that it has found and sets up the surface for scattering. With
/// SURFACES_WAIT it has met one, and arriveAtSky() is for the others.
void arrive() {
    const bool hit = SURFACES_WAIT || ray.hitPrimitive != NO_PRIMITIVE;
    phase = PHASE_ENDED;
    FoundSky sky = NO_SKY;
    if (!hit) sky = skyFrom(departureNormal, ray.direction);
    const float share = foundShare(sky);
    throughput *= transmittance(medium, hit ? ray.tMax : INFINITE_DISTANCE);
    if (!hit) {
        takeInSky(sky, share);
        return;
    }
    surface = surfaceAt(ray);
    if (INTEGRATOR == INTEGRATOR_NORMALS) {
        radiance = 0.5 * shadingNormal(surface) + 0.5;
        return;
    }
    if (INTEGRATOR == INTEGRATOR_DEPTH) {
        radiance = vec3(ray.tMax);
        return;
    }
    if (HAS_BLENDS) {
        surface.material = drawnMaterial(surface);
        found = lookUpMaterial(materialPoint(surface));
    }
    material = found.parameters;
    if (countsEmission) radiance += throughput * emissionAt(surface, material) * share;
    if (isBlackBehind(material) && isSeenFromBehind(surface)) return;
    faceForward(surface);
    applyRelief(surface, found.relief, dependsOnView(material), reliefRules(material));
    if (reliefRules(material) != 0u && dot(shadingNormal(surface), surface.wo) <= 0.0) return;
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

#include "include/direct_samples.glsl"

/// Whether light found by the bounce from here, from one of these lobes, adds to the picture.
bool emissionCounts(uint lobes) {
    return bounce >= frame.minBounce &&
           (isDelta(lobes) || combines(lobes) ||
            DIRECT_LIGHT == DIRECT_BSDF && BOUNCES_FIND_ALL_LIGHT);
}

/// All branches are of one weight. From here on `radiance` is their sum, until finishSample.
void splitPath() {
    splitPoint = SplitPoint(surface, throughput, bounce, medium);
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
    medium = splitPoint.medium;
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
    if (ROULETTE == ROULETTE_THROUGHPUT && bounce >= ROULETTE_START) {
        const float q = min(ROULETTE_MAX_CONTINUE, ROULETTE_BOLDNESS * largest);
        if (roulette >= q) return;
        throughput *= 1.0 / q;
    }
    if (GAP_PROPOSAL) throughput *= mixtureWeight;
    const bool transmitted = isTransmission(b.lobe);
    countsEmission = emissionCounts(b.lobe);
    bouncePdf = combines(b.lobe) ? max(b.pdf, TINY) : 0.0;
    departureNormal = shadingNormal(surface);
    if (isLitFromBothSides(lobesOf(material))) { // as light samples of that side are taken
        bouncePdf *= 2.0;
        departureNormal = transmitted ? -departureNormal : departureNormal;
    }
    medium = mediumBeyond(surface, material, medium, transmitted);
    traceFrom(surface, PHASE_PATH, leave(surface, b.direction, transmitted), b.direction,
              INFINITE_DISTANCE, transmitted);
}

void beginSample() {
    bounce = 0u;
    throughput = vec3(1.0);
    radiance = vec3(0.0);
    countsEmission = frame.minBounce == 0u;
    bouncePdf = 0.0;
    medium = NO_MEDIUM;
    splitPoint.bounce = 0u;
    branchesLeft = 0u;
}

void startCameraRay(vec2 u) {
    const CameraRay c = cameraRayOfSample(pixelAt, pixelId, sampleIndex(), u, filterWeight);
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
    else if (SCATTERS_THROUGH && INTEGRATOR == INTEGRATOR_PATH)
        scatter(vec3(u.zw, TAKES_THREE_NUMBERS(material) ? sideNumber() : u.z), arrivalNumbers.z);
    else if (INTEGRATOR == INTEGRATOR_PATH) scatter(u.zwz, arrivalNumbers.z);
}

/// The path is over, but not the sample.
bool branchIsOver() { return SPLITS && phase == PHASE_ENDED && branchesLeft > 0u; }

void finishSample() {
    if (SPLITS && splitPoint.bounce != 0u) radiance /= float(frame.branches);
    addSample(pixelState, radiance, filterWeight);
    if (samplesHaveWeights()) radiance *= filterWeight; // as frame.keepsValue shows it
    phase = PHASE_NEXT;
}

// --- Service -------------------------------------------------------------------------------------

/// Whether the finished ray asks for a material (askedPoint()), or is one of hemisphere sampling.
bool asksForMaterial() {
    const bool hit = ray.hitPrimitive != NO_PRIMITIVE;
    if (DIRECT_LIGHT == DIRECT_HEMISPHERE && phase == PHASE_HEMISPHERE) return true;
    if (phase == PHASE_PATH) return hit;
    return hit ? HAS_ALPHA : emissionHasFactors() && sampledEmitter.primitive != NO_PRIMITIVE;
}

/// A path ray has met nothing: what arrive() does of that with no surface to set up.
void arriveAtSky() {
    phase = PHASE_ENDED;
    const FoundSky sky = skyFrom(departureNormal, ray.direction);
    throughput *= transmittance(medium, INFINITE_DISTANCE);
    takeInSky(sky, foundShare(sky));
}

/// With SURFACES_WAIT: takes in the finished ray as followPath() does, as far as no material is asked for.
void followFreePath() {
    if (waits) return;
    waits = isTracing(phase) && asksForMaterial();
    if (waits) return;
    if (phase == PHASE_PATH) arriveAtSky();
    else if (phase == PHASE_SHADOW) finishShadowRay();
    if (phase == PHASE_DIRECT && directIndex >= directSamples()) phase = endsHere() ? PHASE_ENDED : PHASE_BOUNCE;
    waits = phase == PHASE_DIRECT || branchIsOver();
    if (phase == PHASE_ENDED && !waits) finishSample();
}

/// Takes in the finished ray. What is next: a shadow ray, which it asks for; a bounce (PHASE_BOUNCE), or
/// another sample (PHASE_NEXT), both by depart().
void followPath() {
    const MaterialPoint asked = askedPoint();
    found = lookUpMaterial(asked);
    if (HAS_ALPHA && passesThrough(asked, found.opacity)) return;
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
