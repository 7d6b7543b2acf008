// What a lane knows between two passes of the state machine (path.glsl), the random numbers it draws, and how it
// asks for rays.

const uint PHASE_FINISHED = 0u;   ///< nothing left to do for this lane
const uint PHASE_PATH = 1u;       ///< tracing a camera or bounce ray
const uint PHASE_SHADOW = 2u;     ///< tracing a ray to a light
const uint PHASE_HEMISPHERE = 3u; ///< tracing a ray of hemisphere sampling
const uint PHASE_DIRECT = 4u;     ///< at a surface, direct light samples left
const uint PHASE_BOUNCE = 5u;     ///< at a surface, direct light done
const uint PHASE_ENDED = 6u;      ///< the path is over
const uint PHASE_NEXT = 7u;       ///< ready for a new sample
const uint PHASE_SUSPENDED = 8u;  ///< a bit: the ray of the phase has been put off to the next dispatch

/// Tracing a ray to a light; kernels that see have none.
bool isToLight(uint phase) { return !SEES && phase == PHASE_SHADOW; }
bool isSuspended(uint phase) { return (phase & PHASE_SUSPENDED) != 0u; }

/// Where a sample's path has split into branches (path splitting; docs/theory/estimator.md, "Branches"): at
/// the first surface that scatters at random.
struct SplitPoint {
    SurfacePoint surface;
    vec3 throughput; ///< before scattering
    uint bounce;     ///< 0: has not split
    uint uncounted;
    Filling filling;
};

/// What of a ray decides in which media it is where borders and surfaces lie in one plane, so that rounding says which of
/// them is met first (docs/theory/media.md, "Borders in the planes of surfaces").
struct Crossing {
    Filling filling; ///< the last one that the ray was in for longer than rounding can make up
    float error;   ///< bound of the distance between what it has passed last and its plane; below 0: it has passed nothing
    bool isUntold; ///< the border passed last says that the ray was in another medium before than it was
};

/// All that a lane knows of the path it follows and of the pixel that the path belongs to. Functions say in
/// their signatures whether they read it (a copy) or change it (inout); the specialiser makes a variable of
/// each member and drops those that a scene does not need (host/spirv).
struct PathState {
    uint phase;
    Traversal ray; ///< what PHASE_PATH, _SHADOW and _HEMISPHERE trace
    float rayEnd;  ///< tMax as it was asked for; the ray's own shrinks to its hits
    uint rayCount; ///< rays begun so far

    PixelState pixelState;
    uint strand;        ///< of the pixel, whose state that is
    uint pixelId;       ///< in the whole picture: names the random numbers
    uvec2 pixelAt;      ///< column, row (from the top) in the whole picture
    float filterWeight; ///< of the sample (pixel_filter.glsl)

    uint bounce; ///< scatterings so far
    uint uncounted; ///< of these: under surfaces, which do not count for the most and the fewest there may be
    vec3 throughput;
    vec3 radiance;
    float brightness; ///< the most that light samples have brought, by the throughput there, halved at each bounce since
    Filling filling;       ///< that the path ray goes through
    Filling shadowFilling; ///< likewise, the light sample's ray under way; in scenes with media
    Crossing crossing;    ///< of the ray under way, where rays pass borders
    bool countsEmission;  ///< light that the ray finds adds to the picture ...
    float bouncePdf;      ///< ... weighted (mis.glsl), by this density of the ray's direction; 0: not weighted
    Aim aim;              ///< of the bounce under way, with AIMS_BOUNCES
    vec3 departureNormal; ///< shading normal of the surface that the ray, a light sample's too, has left, for that weight
    vec3 departurePoint;  ///< likewise: where its light samples were taken (litPoint()), with PORTALS or LIGHT_THROUGH_GLASS
    uint departureTable;  ///< likewise: by which its light samples choose tiles of the environment (guide.glsl)
    ThroughGlass glass;   ///< with LIGHT_THROUGH_GLASS

    // Where samples are of what the camera sees (SEES):
    SeenPixel seen;   ///< of the pixel
    vec3 firstNormal; ///< of the first surface, as it is shaded

    /// What a material is at the point that the finished ray asks for (askedPoint()). One lookup for all, since
    /// every lane takes part in each (docs/theory/kernel.md, "Textures").
    MaterialAtPoint found;
    SurfacePoint surface; ///< where the path scatters next, and light samples are taken
    Material material;    ///< of that surface
    uint directIndex;     ///< direct light samples done there
    /// Drawn with the path ray for where it ends. x, y: for the first light sample there; z: for roulette.
    vec3 arrivalNumbers;
    vec3 directValue; ///< what the ray under way adds if it is free (or, hemisphere, per radiance)
    uint sampledSky;  ///< LightSample::sky of the light sample under way; what it adds is per radiance of the sky
    MaterialPoint sampledEmitter; ///< where the light sample under way has gone (sampleLight())

    SplitPoint splitPoint;
    uint branchesLeft; ///< that have not begun

    // Where the path is recorded (RECORDS):
    uint eventCount;    ///< of the sample under way
    uint recordedLight; ///< that the light sample under way goes to
    float recordedPdf;  ///< its density, as PathEvent::pdf
};

#include "include/camera_sample.glsl"

/// Direct light samples at a surface: directions of hemisphere sampling, then samples of lights.
uint directSamples(const Frame frame) { return frame.hemisphereSamples + frame.lightSamples; }

/// A light sample is on its way through glass, as a path ray.
bool isThroughGlass(PathState path) { return LIGHT_THROUGH_GLASS && path.glass.isUnderWay; }

/// Scatterings that count so far.
uint countedBounces(uint bounce, uint uncounted) { return WALKS ? bounce - uncounted : bounce; }

uint samplesTaken(PathState path) { return path.pixelState.count + path.pixelState.rejected; }

/// The number of the sample under way, or the next one, of this pixel.
uint sampleIndex(const Frame frame, PathState path) {
    if (STRANDS == 0u) return frame.firstSample + samplesTaken(path);
    return frame.firstSample + path.strand + STRANDS * samplesTaken(path);
}

/// A branch has samples and blocks of its own: where it draws the numbers of a block. splitAt: SplitPoint::bounce.
void addressBranch(uint splitAt, uint branchesLeft, uint branches, inout uint sample_, inout uint block) {
    if (SPLITS && splitAt != 0u) {
        sample_ = sample_ * branches + branches - 1u - branchesLeft;
        block |= BRANCH_BLOCKS;
    }
}

/// Block 0 of a path ray, `bounce` of its path, is for the ray itself and for what happens where it ends;
/// further light samples there take the blocks after it.
uvec4 pathWords(const Frame frame, PathState path, uint slot) {
    uint sample_ = sampleIndex(frame, path), block = path.bounce * (1u + directSamples(frame)) + slot;
    addressBranch(path.splitPoint.bounce, path.branchesLeft, frame.branches, sample_, block);
    return randomWords(path.pixelId, sample_, block, frame.seed);
}

/// The third number of a bounce: of a block of its own, and not spread evenly.
float sideNumber(const Frame frame, PathState path) {
    uint sample_ = sampleIndex(frame, path), block = path.bounce | CHOICE_BLOCKS;
    addressBranch(path.splitPoint.bounce, path.branchesLeft, frame.branches, sample_, block);
    return unitFloats(pcg4d(uvec4(path.pixelId, sample_, block, frame.seed))).x;
}

#include "include/pass_through.glsl"

/// Asks for a ray. Rays are prepared in one place, startRay() (docs/theory/kernel.md, "What llvmpipe does").
void trace(inout PathState path, uint newPhase, vec3 origin, vec3 direction, float tMin, float tMax, uint skipPrimitive) {
    path.phase = newPhase;
    path.ray.origin = origin;
    path.ray.direction = direction;
    path.ray.tMin = tMin;
    path.ray.tMax = tMax;
    path.ray.skipPrimitive = skipPrimitive;
    path.ray.passed = NO_PRIMITIVE;
    path.rayEnd = tMax;
    if (PASSES_BORDERS) {
        path.crossing = Crossing(path.filling, -1.0, false);
        if (newPhase != PHASE_PATH) path.crossing.filling = path.shadowFilling;
    }
    path.ray.skipPlacement = NO_PLACEMENT;
}

/// Begins a ray from a surface, whose own primitive is the one that is skipped.
void traceFrom(inout PathState path, SurfacePoint s, uint newPhase, vec3 origin, vec3 direction, float tMax, bool transmitted) {
    trace(path, newPhase, origin, direction, 0.0, tMax, skipOnLeaving(s, transmitted));
    path.ray.skipPlacement = s.placement;
}

bool isTracing(uint p) {
    return p == PHASE_PATH || p == PHASE_SHADOW ||
           (DIRECT_LIGHT == DIRECT_HEMISPHERE && p == PHASE_HEMISPHERE);
}

void startRay(inout PathState path, inout Stack stack) {
    if (!isTracing(path.phase) || traversing(path.ray)) return;
    // What may be glass has to be met first.
    path.ray.anyHit = isToLight(path.phase) && !HAS_ALPHA && !LIGHT_THROUGH_GLASS;
    startTraversal(path.ray, stack);
    ++path.rayCount;
}

/// Light that the path has found: after the first bounce that counts no more than the limit, where there is one.
vec3 limited(PathState path, vec3 light) {
    float share = 1.0;
    const float most = max(light.x, max(light.y, light.z));
    if (CLAMPS_INDIRECT && countedBounces(path.bounce, path.uncounted) > 1u && most > INDIRECT_LIMIT) share = INDIRECT_LIMIT / most;
    return CLAMPS_INDIRECT ? light * share : light;
}
