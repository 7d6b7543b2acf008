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
bool countsEmission; ///< a lamp found by the ray adds to the picture ...
float bouncePdf; ///< ... weighted, if it came from a surface where MIS combines (mis.glsl): density; else 0
SurfacePoint surface;
Material material;
uint directIndex; ///< direct light samples done at this surface
/// Drawn with the path ray for where it ends. x, y: for the first light sample there, unless
/// LIGHT_NUMBERS_OWN; z: for roulette.
vec3 arrivalNumbers;
vec3 directValue; ///< what the ray under way adds if it is free (or, hemisphere, per radiance)
uint rayCount;

/// Where a sample's path has split into branches (docs/estimator.md, "Branches"): at the first surface
/// that scatters at random.
struct SplitPoint {
    SurfacePoint surface;
    vec3 throughput; ///< before scattering
    uint bounce;     ///< 0: has not split
};
SplitPoint splitPoint;
uint branchesLeft; ///< that have not begun

/// Blocks of random numbers that branches take: none of those before paths split.
const uint BRANCH_BLOCKS = 0x80000000u;

/// The number of the sample under way, or the next one, of this pixel.
uint sampleIndex() { return frame.firstSample + pixelState.count + pixelState.rejected; }

/// Block 0 of a path ray, `bounce` of its path, is for the ray itself and for what happens where it ends;
/// further light samples there take the blocks after it.
uvec4 randomWords(uint slot) {
    const uint block = bounce * (1u + frame.areaSamples + frame.deltaLights) + slot;
    if (!SPLITS || splitPoint.bounce == 0u)
        return randomWords(pixelId, sampleIndex(), block, frame.seed);
    const uint branch = frame.branches - 1u - branchesLeft;
    return randomWords(pixelId, sampleIndex() * frame.branches + branch, BRANCH_BLOCKS | block,
                       frame.seed);
}

/// Asks for a ray. It is started by startRay(): llvmpipe runs every branch for all lanes, so that
/// preparing a ray wherever one is asked for would be paid for every time.
void trace(uint newPhase, vec3 origin, vec3 direction, float tMin, float tMax, uint skipPrimitive) {
    phase = newPhase;
    ray.origin = origin;
    ray.direction = direction;
    ray.tMin = tMin;
    ray.tMax = tMax;
    ray.skipPrimitive = skipPrimitive;
}

bool isTracing(uint p) {
    return p == PHASE_PATH || p == PHASE_SHADOW ||
           (DIRECT_LIGHT == DIRECT_HEMISPHERE && p == PHASE_HEMISPHERE);
}

void startRay() {
    if (!isTracing(phase) || traversing(ray)) return;
    ray.anyHit = phase == PHASE_SHADOW;
    startTraversal(ray);
    ++rayCount;
}

// --- Arrivals ----------------------------------------------------------------------------------

vec3 emissionAt(SurfacePoint s, Material m) {
    if (!HAS_EMISSION) return vec3(0.0);
    return m.emitsBothSides != 0u || s.outside ? m.emission : vec3(0.0);
}

/// What MIS leaves to this bounce of the ambient light it has found.
float ambientWeight() {
    if (!USE_MIS || bouncePdf == 0.0) return 1.0;
    return bounceWeight(AMBIENT_INVERSE_PDF, bouncePdf);
}

/// The same of an emissive surface, `material`; all of what no bounce is expected to find is light samples'.
float emitterWeight() {
    if (!USE_MIS || bouncePdf == 0.0) return 1.0;
    if (material.light == NO_LIGHT) return 0.0;
    return bounceWeight(lightSampleInversePdf(ray, material.light), bouncePdf);
}

void finishShadowRay() {
    if (ray.hitPrimitive == NO_PRIMITIVE) radiance += throughput * directValue;
    phase = PHASE_DIRECT;
}

void finishHemisphereRay() {
    const bool hit = ray.hitPrimitive != NO_PRIMITIVE;
    vec3 found = CS184 ? vec3(0.0) : ambientRadiance(ray.direction);
    if (hit) {
        const SurfacePoint s = surfaceAt(ray);
        found = emissionAt(s, fetchMaterial(s.material));
    }
    radiance += throughput * directValue * found;
    phase = PHASE_DIRECT;
}

/// A path ray is done: takes in the emission and sets up the surface for scattering.
void arrive() {
    const bool hit = ray.hitPrimitive != NO_PRIMITIVE;
    phase = PHASE_ENDED;
    if (!hit) {
        if (countsEmission && bounce > 0u && !CS184)
            radiance += throughput * ambientRadiance(ray.direction) * ambientWeight();
        return;
    }
    surface = surfaceAt(ray);
    if (INTEGRATOR == INTEGRATOR_NORMALS) {
        radiance = 0.5 * shadingNormal(surface) + 0.5;
        return;
    }
    material = fetchMaterial(surface.material);
    if (countsEmission) radiance += throughput * emissionAt(surface, material) * emitterWeight();
    faceForward(surface);
    ++bounce;
    if (bounce > frame.maxBounces) return;
    if (ROULETTE == ROULETTE_FIXED) {
        if (arrivalNumbers.z < frame.terminationProbability) return;
        throughput /= 1.0 - frame.terminationProbability;
    }
    const bool direct = !isDelta(material.kind) && bounce >= frame.minBounce;
    directIndex = direct ? 0u : frame.areaSamples + frame.deltaLights;
    phase = PHASE_DIRECT;
}

// --- Departures --------------------------------------------------------------------------------

/// Starts the ray of the next hemisphere sample.
void sampleHemisphere(vec4 u) {
    const vec3 w = toWorld(makeFrame(shadingNormal(surface)), sampleUniformHemisphere(u.xy));
    directValue = evaluateBsdf(material, surface, w) * (2.0 * PI / float(frame.areaSamples));
    if (dot(directValue, vec3(1.0)) > 0.0)
        trace(PHASE_HEMISPHERE, leave(surface, w, false), w, 0.0, INFINITE_DISTANCE,
              skipOnLeaving(surface, false));
}

Light lightOf(uint index) {
    return lightNumber(index < frame.areaSamples ? index / LIGHT_SAMPLES
                                                 : frame.areaLights + index - frame.areaSamples);
}

/// Starts the shadow ray of the next light sample, if that light can reach the surface.
void sampleLights(vec4 u, uint index) {
    const bool isArea = index < frame.areaSamples;
    const LightSample light = sampleLight(surface, lightOf(index), u);
    const float share = isArea ? 1.0 / float(LIGHT_SAMPLES) : 1.0;
    directValue = evaluateBsdf(material, surface, light.direction) * light.radiance * share;
    if (!(dot(directValue, vec3(1.0)) > 0.0)) return;
    if (combines(material))
        directValue *= lightSampleWeight(light.inversePdf,
                                         microfacetPdf(material, surface, light.direction));
    const vec3 origin = leave(surface, light.direction, false);
    const uint skip = skipOnLeaving(surface, false);
    if (light.infinite)
        trace(PHASE_SHADOW, origin, light.direction, 0.0, INFINITE_DISTANCE, skip);
    else
        trace(PHASE_SHADOW, origin, light.target - origin, 0.0, 1.0, skip);
}

/// One direct light sample; a sample that cannot contribute traces nothing.
void sampleDirect() {
    const uint index = directIndex++;
    vec4 u = vec4(arrivalNumbers.xy, 0.0, 0.0);
    if (LIGHT_NUMBERS == LIGHT_NUMBERS_OWN || LIGHT_NUMBERS == LIGHT_NUMBERS_FIRST && index > 0u)
        u = unitFloats(randomWords(1u + index));
    if (DIRECT_LIGHT == DIRECT_HEMISPHERE && index < frame.areaSamples)
        sampleHemisphere(u);
    else
        sampleLights(u, index);
}

/// A lamp found by the bounce from here adds to the picture.
bool emissionCounts() {
    return bounce >= frame.minBounce && (isDelta(material.kind) || combines(material) ||
                                         (DIRECT_LIGHT == DIRECT_BSDF && !CS184));
}

/// All branches are of one weight. From here on `radiance` is their sum, until finishSample.
void splitPath() {
    splitPoint = SplitPoint(surface, throughput, bounce);
    branchesLeft = frame.branches - 1u;
    radiance *= float(frame.branches);
}

/// Goes back to where the path split, with the next branch.
void nextBranch() {
    --branchesLeft;
    surface = splitPoint.surface;
    material = fetchMaterial(surface.material);
    throughput = splitPoint.throughput;
    bounce = splitPoint.bounce;
    phase = PHASE_BOUNCE;
}

/// No bounce from here would be traced.
bool endsHere() { return bounce == frame.maxBounces && !emissionCounts(); }

/// u: for the direction; roulette: for its end.
void scatter(vec2 u, float roulette) {
    phase = PHASE_ENDED;
    const bool guided = looksIntoGap(surface, material), aims = guided && u.x < GAP_SHARE;
    if (guided) u = afterChoice(u);
    BsdfSample b = sampleBsdf(material, surface, u);
    const float guideWeight = guided ? mixWithGap(b, material, surface, aims, u) : 1.0;
    throughput *= b.weight;
    const float largest = largestComponent(throughput);
    if (!(largest > 0.0)) return;
    if (ROULETTE == ROULETTE_THROUGHPUT && bounce >= ROULETTE_THROUGHPUT_START) {
        const float q = min(ROULETTE_MAX_CONTINUE, ROULETTE_BOLDNESS * largest);
        if (roulette >= q) return;
        throughput *= 1.0 / q;
    }
    // After roulette: a small weight is no reason to end a path that goes where it is bright.
    if (guided) throughput *= guideWeight;
    countsEmission = emissionCounts();
    bouncePdf = combines(material) ? max(microfacetPdf(material, surface, b.direction), TINY) : 0.0;
    trace(PHASE_PATH, leave(surface, b.direction, b.transmitted), b.direction, 0.0,
          INFINITE_DISTANCE, skipOnLeaving(surface, b.transmitted));
}

void beginSample() {
    bounce = 0u;
    throughput = vec3(1.0);
    radiance = vec3(0.0);
    countsEmission = frame.minBounce == 0u;
    bouncePdf = 0.0;
    splitPoint.bounce = 0u;
    branchesLeft = 0u;
}

void startCameraRay(vec2 u) {
    const CameraRay c = cameraRay(vec2(ivec2(pixelAt)) + u);
    trace(PHASE_PATH, c.origin, c.direction, c.tMin, c.tMax, NO_PRIMITIVE);
}

/// Starts the next path ray: of a new sample (PHASE_NEXT), or the bounce (PHASE_BOUNCE). Both draw their
/// numbers in one place, as llvmpipe would run two for all lanes. A bounce may end the path.
void depart() {
    const bool begins = phase == PHASE_NEXT;
    if (begins) beginSample();
    else if (SPLITS && splitPoint.bounce == 0u && scattersAtRandom(material.kind)) splitPath();
    const uvec4 words = randomWords(0u);
    const vec4 u = unitFloats(words);
    arrivalNumbers = vec3(u.xy, leftOver(words));
    const vec2 direction = LIGHT_NUMBERS == LIGHT_NUMBERS_OWN ? u.xy : u.zw;
    if (begins) startCameraRay(direction);
    else if (INTEGRATOR == INTEGRATOR_PATH) scatter(direction, arrivalNumbers.z);
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
    if (phase == PHASE_SHADOW) finishShadowRay();
    else if (DIRECT_LIGHT == DIRECT_HEMISPHERE && phase == PHASE_HEMISPHERE) finishHemisphereRay();
    else if (phase == PHASE_PATH) arrive();

    if (INTEGRATOR == INTEGRATOR_PATH) {
        const uint directSamples = frame.areaSamples + frame.deltaLights;
        if (phase == PHASE_DIRECT && directIndex < directSamples) sampleDirect();
        if (phase == PHASE_DIRECT && directIndex >= directSamples)
            phase = endsHere() ? PHASE_ENDED : PHASE_BOUNCE;
        if (branchIsOver()) nextBranch();
    }
    if (phase == PHASE_ENDED && !branchIsOver()) finishSample();
}
