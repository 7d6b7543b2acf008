// The path tracer as a state machine. Each lane is in one phase; its rays are traced a few steps
// at a time (traverse.glsl), and a lane whose ray is done is served here: it takes in the result,
// works out its next ray, and begins its next sample as soon as a path ends, so that lanes stay
// busy. docs/theory/estimator.md defines what a sample is.

#include "include/path_state.glsl"
#include "include/media.glsl"
#include "include/seeing.glsl"
#include "include/roulette.glsl"
#include "include/recording.glsl"
#include "include/through_glass.glsl"

// --- Arrivals ----------------------------------------------------------------------------------

vec3 emissionAt(SurfacePoint s, Material m) {
    if (!HAS_EMISSION) return vec3(0.0);
    return emitsBothSides(m) || s.outside ? emissionOf(m) : vec3(0.0);
}

/// The share of the light that the path ray has found that is this ray's, and not light samples'.
float foundShare(const Given given, PathState path, FoundSky sky) {
    const StraightRay straight = StraightRay(isBehindGlass(path), isThroughGlass(path), path.glass.light, keepsDirection(path));
    if (!straight.isBehindGlass && (MIS_LOBES == 0u || path.bouncePdf == 0.0)) return 1.0;
    Traversal t = path.ray;
    if (straight.isBehindGlass) {
        t.origin = path.departurePoint;
        t.direction = path.glass.direction;
    }
    return foundLightWeight(given, t, path.departureNormal, sky, path.bouncePdf, straight);
}

MaterialPoint askedPoint(PathState path) {
    if (scattersInMedium(path.ray)) return MaterialPoint(path.filling.medium, NO_PRIMITIVE, vec2(0.0));
    if (path.ray.hitPrimitive != NO_PRIMITIVE) return materialPoint(path.ray.hitPrimitive, vec2(path.ray.b1, path.ray.b2));
    if (emissionHasFactors() && isToLight(path.phase)) return path.sampledEmitter;
    return MaterialPoint(0u, NO_PRIMITIVE, vec2(0.0));
}

/// What the ray that is done has found of the sky, if it has met nothing.
FoundSky foundSky(const Given given, PathState path) {
    FoundSky sky = NO_SKY;
    if (path.ray.hitPrimitive == NO_PRIMITIVE)
        sky = skyFrom(given, path.departurePoint, path.departureNormal, path.departureTable, directionToSky(path));
    return sky;
}

void finishShadowRay(inout PathState path, FoundSky sky) {
    if (findsSkyOnArrival() && path.sampledSky != NOT_SKY) path.directValue *= arrivedFrom(sky, path.sampledSky, path.bouncePdf);
    if (emissionHasFactors() && path.sampledEmitter.primitive != NO_PRIMITIVE)
        path.directValue *= emissionFactorOf(path.found);
    path.phase = PHASE_DIRECT;
    const bool mayBeGlass = LIGHT_THROUGH_GLASS && (HAS_BLENDS || isClear(path.found.parameters));
    if (path.ray.hitPrimitive == NO_PRIMITIVE) {
        const vec3 light = limited(path, path.throughput * path.directValue);
        path.radiance += light;
        noteBrightness(path, path.directValue);
        if (RECORDS) recordArrivedLight(path, light);
    } else if (mayBeGlass && dot(path.glass.share, vec3(1.0)) > 0.0) {
        enterGlass(path);
    }
}

void finishHemisphereRay(const Given given, inout PathState path) {
    const bool hit = path.ray.hitPrimitive != NO_PRIMITIVE;
    vec3 arriving = BOUNCES_FIND_ALL_LIGHT ? skyFrom(given, path.departurePoint, path.ray.direction, path.departureTable, path.ray.direction).radiance : vec3(0.0);
    if (hit) {
        const SurfacePoint s = surfaceAt(path.ray);
        arriving = emissionAt(s, materialAt(s));
    }
    arriving *= transmittance(fillingBeyond(path.surface, path.material, path.filling, isBehind(path.surface, path.ray.direction)).medium,
                           path.ray.tMax);
    const vec3 light = limited(path, path.throughput * path.directValue * arriving);
    path.radiance += light;
    if (RECORDS) recordArrivedLight(path, light);
    path.phase = PHASE_DIRECT;
}

/// Adds the light of the sky that the path ray has found. share: of it that is this ray's (foundShare()).
void takeInSky(const Frame frame, inout PathState path, FoundSky sky, float share) {
    const bool counts = path.countsEmission || AMBIENT_BY_BOUNCES && countedBounces(path.bounce, path.uncounted) >= frame.minBounce;
    const bool adds = counts && (path.bounce > 0u || HAS_BACKDROP) && BOUNCES_FIND_ALL_LIGHT;
    vec3 light = vec3(0.0);
    vec3 found = sky.radiance;
    if (findsSkyOnArrival() && isThroughGlass(path)) found = arrivedFrom(sky, path.sampledSky, path.bouncePdf);
    if (adds) light = limited(path, path.throughput * found * share);
    path.radiance += light;
    if (isThroughGlass(path)) arriveThroughGlass(path, light, share);
    else if (RECORDS) recordMiss(path, light, share);
}

/// A path ray is done: takes in the light that it has found and sets up the surface for scattering.
/// found: of the sky, where that is looked up for light samples, too.
void arrive(const Given given, inout PathState path, FoundSky found) {
    const bool hit = path.ray.hitPrimitive != NO_PRIMITIVE, inMedium = scattersInMedium(path.ray);
    FoundSky sky = found;
    if (!findsSkyOnArrival()) sky = foundSky(given, path);
    path.phase = PHASE_ENDED;
    float share = 1.0;
    if (!inMedium) share = foundShare(given, path, sky);
    path.throughput *= transmittance(path.filling.medium, hit ? path.ray.tMax : INFINITE_DISTANCE);
    if (!hit) {
        if (SEES) seeNothing(path);
        else takeInSky(given.frame, path, sky, share);
        return;
    }
    if (!inMedium) path.surface = surfaceAt(path.ray);
    if (inMedium) path.surface = pointInMedium(path.ray, path.filling.medium);
    float aimed = 1.0;
    if (AIMS_BOUNCES) {
        aimed = aimedWeight(given.frame, path.aim, path.ray, path.surface.geometric);
        path.throughput *= aimed;
        path.aim.weight *= aimed;
        if (RECORDS && aimed == 0.0) recordArrival(path, vec3(0.0), 1.0, 1.0, aimed);
        if (aimed == 0.0) return;
    }
    if (PASSES_BORDERS && !inMedium) settleMedium(path);
    if (INTEGRATOR == INTEGRATOR_NORMALS) {
        path.radiance = 0.5 * shadingNormal(path.surface) + 0.5;
        return;
    }
    if (INTEGRATOR == INTEGRATOR_DEPTH) {
        path.radiance = vec3(path.ray.tMax);
        return;
    }
    if (SEES && path.bounce == 0u) countHit(path);
    if (INTEGRATOR == INTEGRATOR_COVERAGE) return;
    if (HAS_BLENDS) {
        if (SEES) path.surface.material = materialOfSide(path.surface);
        else drawMaterial(path.surface, hitWordsOfPath(given.frame, path));
        path.found = lookUpMaterial(materialPoint(path.surface));
    }
    path.material = inMixture(path.found.parameters, path.surface);
    vec3 light = vec3(0.0);
    if (path.countsEmission) light = limited(path, path.throughput * emissionAt(path.surface, path.material) * share);
    path.radiance += light;
    const bool isSample = isThroughGlass(path);
    if (isSample) arriveThroughGlass(path, light, share);
    else if (RECORDS)
        recordArrival(path, light, share, 1.0 - (ROULETTE == ROULETTE_FIXED ? given.frame.terminationProbability : 0.0), aimed);
    const bool isGlass = isClear(path.material) && (!HAS_ALPHA || path.found.opacity >= 1.0);
    if (isSample && !isGlass) return;
    if (LIGHT_THROUGH_GLASS && !isGlass) path.glass.isFromLit = false;
    if (isBlackBehind(path.material) && isSeenFromBehind(path.surface)) return;
    if (!inMedium) {
        if (RELIEF_RULES) mirrorBehind(path.found.relief, path.surface);
        faceForward(path.surface);
        applyRelief(path.surface, path.found.relief, dependsOnView(path.material), reliefRules(path.material));
    }
    path.surface.table = guideTable(path.surface);
    if (INTEGRATOR == INTEGRATOR_LAYERS) {
        seeSurface(path);
        return;
    }
    if (reliefRules(path.material) != 0u && dot(shadingNormal(path.surface), path.surface.wo) <= 0.0) return;
    ++path.bounce;
    if (WALKS && isUnderSurface(path.filling.medium)) ++path.uncounted;
    if (countedBounces(path.bounce, path.uncounted) > given.frame.maxBounces) return;
    if (WALKS && path.uncounted >= MOST_UNDER_SURFACE) return;
    if (isSample) {
        path.phase = PHASE_BOUNCE;
        return;
    }
    if (ROULETTE == ROULETTE_FIXED) {
        if (path.arrivalNumbers.z < given.frame.terminationProbability) return;
        path.throughput /= 1.0 - given.frame.terminationProbability;
    }
    const bool direct =
        scattersIntoManyDirections(lobesOf(path.material)) && countedBounces(path.bounce, path.uncounted) >= given.frame.minBounce;
    path.directIndex = direct ? 0u : directSamples(given.frame);
    path.phase = PHASE_DIRECT;
}

// --- Departures --------------------------------------------------------------------------------

#include "include/direct_samples.glsl"

/// Whether light found by the bounce from here, from one of these lobes, adds to the picture.
bool emissionCounts(const Frame frame, PathState path, uint lobes) {
    return countedBounces(path.bounce, path.uncounted) >= frame.minBounce &&
           (isDelta(lobes) || combines(lobes) ||
            DIRECT_LIGHT == DIRECT_BSDF && BOUNCES_FIND_ALL_LIGHT);
}

/// All branches are of one weight. From here on `radiance` is their sum, until finishSample.
void splitPath(const Frame frame, inout PathState path) {
    path.splitPoint = SplitPoint(path.surface, path.throughput, path.bounce, path.uncounted, path.filling);
    path.branchesLeft = frame.branches - 1u;
    path.radiance *= float(frame.branches);
}

/// Goes back to where the path split, with the next branch. material: drawn at that surface.
void nextBranch(inout PathState path, Material material) {
    --path.branchesLeft;
    path.surface = path.splitPoint.surface;
    path.material = inMixture(material, path.surface);
    path.throughput = path.splitPoint.throughput;
    if (AIMS_BOUNCES) path.aim.weight = 1.0; // only surfaces that do not aim come before,
    path.glass.isFromLit = false;            // nor take light samples
    path.bounce = path.splitPoint.bounce;
    path.brightness = 0.0;
    if (WALKS) path.uncounted = path.splitPoint.uncounted;
    path.filling = path.splitPoint.filling;
    path.phase = PHASE_BOUNCE;
}

/// No bounce from here would be traced.
bool endsHere(const Frame frame, PathState path) {
    return path.bounce == frame.maxBounces && !AMBIENT_BY_BOUNCES && !mediaDo(MEDIA_SHINE) && !WALKS && !emissionCounts(frame, path, lobesOf(path.material));
}

/// u: as sampleBsdf() takes it; roulette: for the path's end.
void scatter(const Given given, inout PathState path, vec3 u, float roulette) {
    path.phase = PHASE_ENDED;
    float mixtureWeight;
    BsdfSample b;
    if (AIMS_BOUNCES) b = sampleBsdfOrAim(given.frame, path.material, path.surface, u, path.aim, mixtureWeight);
    else b = ofMixture(sampleBsdfOrGap(given.gap, path.material, path.surface, u, mixtureWeight), path.surface);
    if (SEES) path.throughput *= tintOf(path.material, b);
    else path.throughput *= b.weight;
    if (isThroughGlass(path)) {
        const bool goesThrough = b.lobe == LOBE_DELTA_TRANSMISSION && path.bounce - path.glass.bounce <= MOST_PANES;
        path.throughput *= goesThrough ? b.pdf : 0.0; // not by chance
        roulette = 0.0;
        mixtureWeight = 1.0;
    }
    float largest = largestComponent(path.throughput);
    if (AIMS_BOUNCES && !isThroughGlass(path)) largest = throughputForRoulette(path.aim, path.material, largest);
    if (RECORDS && !isThroughGlass(path)) recordBounce(path, b, largest, roulette, mixtureWeight);
    if (!(largest > 0.0)) {
        if (SEES) endAtNothing(path.seen, vec3(0.0), path.firstNormal);
        return;
    }
    if (endsByThroughput() && path.bounce >= ROULETTE_START && !isThroughGlass(path)) {
        const float q = survival(path, largest);
        if (roulette >= q) return;
        path.throughput *= 1.0 / q;
    }
    if (!isThroughGlass(path)) fadeBrightness(path);
    if (GAP_PROPOSAL || AIMS_BOUNCES) path.throughput *= mixtureWeight;
    const bool transmitted = isTransmission(b.lobe);
    path.countsEmission = emissionCounts(given.frame, path, b.lobe);
    if (departs(given.frame, path, b)) {
        path.bouncePdf = combines(b.lobe) ? max(b.pdf, TINY) : 0.0;
        path.departureNormal = shadingNormal(path.surface);
        const SurfacePoint lit = sideLit(path.surface, path.material, transmitted);
        path.departureTable = lit.table;
        path.departurePoint = litPoint(lit);
        if (isLitFromBothSides(lobesOf(path.material))) { // as light samples of that side are taken
            path.bouncePdf *= 2.0;
            path.departureNormal = transmitted ? -path.departureNormal : path.departureNormal;
        }
    }
    path.filling = fillingBeyond(path.surface, path.material, path.filling, transmitted);
    traceFrom(path, path.surface, PHASE_PATH, leaveThroughMedia(path.surface, b.direction, transmitted), b.direction,
              INFINITE_DISTANCE, transmitted);
}

void beginSample(const Frame frame, inout PathState path) {
    path.bounce = 0u;
    path.uncounted = 0u;
    path.throughput = vec3(1.0);
    path.radiance = vec3(0.0);
    path.brightness = 0.0;
    path.countsEmission = frame.minBounce == 0u;
    path.bouncePdf = 0.0;
    if (AIMS_BOUNCES) path.aim = NO_AIM;
    if (LIGHT_THROUGH_GLASS) {
        path.glass.isUnderWay = false;
        path.glass.isFromLit = false;
        path.glass.panes = 0u;
    }
    path.departureTable = GUIDES_LIGHT ? GUIDE_NODES : OWN_TABLE;
    path.departurePoint = frame.cameraPosition;
    path.filling = fillingOf(HAS_MEDIA ? frame.cameraMedium : NO_MEDIUM);
    path.splitPoint.bounce = 0u;
    path.branchesLeft = 0u;
    if (RECORDS) path.eventCount = 0u;
}

void startCameraRay(const Given given, inout PathState path, vec2 u) {
    const CameraRay c = cameraRayOfSample(given, path.pixelAt, path.pixelId, sampleIndex(given.frame, path), u, path.filterWeight);
    trace(path, PHASE_PATH, c.origin, c.direction, c.tMin, c.tMax, NO_PRIMITIVE);
    if (RECORDS) recordCamera(path);
}

/// Starts the next path ray: of a new sample (PHASE_NEXT), or the bounce (PHASE_BOUNCE). Both draw
/// their numbers in one place (docs/theory/kernel.md, "What llvmpipe does"). A bounce may end the path.
void depart(const Given given, inout PathState path) {
    const bool begins = path.phase == PHASE_NEXT;
    if (begins) beginSample(given.frame, path);
    else if (SPLITS && path.splitPoint.bounce == 0u && !isThroughGlass(path) && scattersAtRandom(lobesOf(path.material))) splitPath(given.frame, path);
    const uvec4 words = pathWords(given.frame, path, 0u);
    const vec4 u = unitFloats(words);
    if (!isThroughGlass(path)) path.arrivalNumbers = vec3(u.xy, leftOver(words));
    // Most materials take either the two numbers within a lobe or the one that chooses a side, so that both may be
    // the same; where nothing else takes the first number of the block, it chooses.
    if (begins) startCameraRay(given, path, u.zw);
    else if (INTEGRATOR == INTEGRATOR_PATH || SEES_SURFACES) {
        vec3 numbers;
        if (SEES) numbers = u.zwx;
        else if (SCATTERS_THROUGH)
            numbers = vec3(u.zw, takesThreeNumbers(lobesOf(path.material)) ? sideNumber(given.frame, path) : u.z);
        else numbers = u.zwz;
        if (isThroughGlass(path)) numbers = vec3(1.0 - UNIT_ROUNDOFF); // the interface, which lets light through if it can
        scatter(given, path, numbers, path.arrivalNumbers.z);
    }
}

/// The path is over, but not the sample.
bool branchIsOver(PathState path) { return SPLITS && !isThroughGlass(path) && path.phase == PHASE_ENDED && path.branchesLeft > 0u; }

void finishSample(const Frame frame, inout PathState path) {
    if (SPLITS && path.splitPoint.bounce != 0u) path.radiance /= float(frame.branches);
    if (SEES) ++path.pixelState.count;
    else addSample(path.pixelState, path.radiance, path.filterWeight);
    if (samplesHaveWeights()) path.radiance *= path.filterWeight; // as frame.keepsValue shows it
    path.phase = PHASE_NEXT;
}

// --- Service -------------------------------------------------------------------------------------

/// Takes in the finished ray: its light, and where the path is now (PHASE_DIRECT, PHASE_ENDED). asked: the point whose
/// material is looked up. False: the ray goes on, as it has met something that is not there.
bool takeInRay(const Given given, inout PathState path, MaterialPoint asked) {
    path.found = lookUpMaterial(asked);
    if (HAS_ALPHA && passesThrough(given.frame, path, asked, path.found.opacity)) return false;
    FoundSky sky = NO_SKY;
    if (findsSkyOnArrival() && isTracing(path.phase)) sky = foundSky(given, path);
    if (isToLight(path.phase)) finishShadowRay(path, sky);
    else if (DIRECT_LIGHT == DIRECT_HEMISPHERE && path.phase == PHASE_HEMISPHERE) finishHemisphereRay(given, path);
    if (path.phase == PHASE_PATH) arrive(given, path, sky);
    comeBackFromGlass(path);
    return true;
}

bool wantsDirectSample(const Frame frame, PathState path) {
    return INTEGRATOR == INTEGRATOR_PATH && path.phase == PHASE_DIRECT && path.directIndex < directSamples(frame);
}

/// When all direct light samples are done, what follows is a bounce, if one would be traced.
void leaveDirectLight(const Frame frame, inout PathState path) {
    if (INTEGRATOR == INTEGRATOR_PATH && path.phase == PHASE_DIRECT && path.directIndex >= directSamples(frame))
        path.phase = endsHere(frame, path) ? PHASE_ENDED : PHASE_BOUNCE;
}

/// Takes in the finished ray. What is next: a shadow ray, which it asks for; a bounce (PHASE_BOUNCE), or
/// another sample (PHASE_NEXT), both by depart().
void followPath(const Given given, inout PathState path) {
    if (goThroughMedium(given, path) || !takeInRay(given, path, askedPoint(path))) return;
    if (wantsDirectSample(given.frame, path)) sampleDirect(given, path);
    leaveDirectLight(given.frame, path);
    if (INTEGRATOR == INTEGRATOR_PATH && branchIsOver(path)) nextBranch(path, materialAt(path.splitPoint.surface));
    if (path.phase == PHASE_ENDED && !branchIsOver(path)) finishSample(given.frame, path);
}
