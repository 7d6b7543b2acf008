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
float filterWeight; ///< of the sample (pixel_filter.glsl)
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
uint medium; ///< that the path ray goes through: the first row of a material, or NO_MEDIUM
bool waits; ///< with SURFACES_WAIT: what comes next needs a material, and other lanes are waited for

/// Where a sample's path has split into branches (path splitting; docs/estimator.md, "Branches"): at
/// the first surface that scatters at random.
struct SplitPoint {
    SurfacePoint surface;
    vec3 throughput; ///< before scattering
    uint bounce;     ///< 0: has not split
    uint medium;
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

/// That of the sample under way, when its path is taken up again: samples have few numbers to remember.
void restoreFilterWeight() {
    const vec4 u = unitFloats(randomWords(pixelId, sampleIndex(), 0u, frame.seed));
    placeInPixel(u.zw, filterWeight);
}

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

/// Asks for a ray. Rays are prepared in one place, startRay() (docs/kernel.md, "What llvmpipe does").
void trace(uint newPhase, vec3 origin, vec3 direction, float tMin, float tMax, uint skipPrimitive) {
    phase = newPhase;
    ray.origin = origin;
    ray.direction = direction;
    ray.tMin = tMin;
    ray.tMax = tMax;
    ray.skipPrimitive = skipPrimitive;
    ray.passed = NO_PRIMITIVE;
    rayEnd = tMax;
    ray.skipPlacement = NO_PLACEMENT;
}

/// The same from a surface, whose own primitive is the one that is skipped.
void traceFrom(SurfacePoint s, uint newPhase, vec3 origin, vec3 direction, float tMax, bool transmitted) {
    trace(newPhase, origin, direction, 0.0, tMax, skipOnLeaving(s, transmitted));
    ray.skipPlacement = s.placement;
}

bool isTracing(uint p) {
    return p == PHASE_PATH || p == PHASE_SHADOW ||
           (DIRECT_LIGHT == DIRECT_HEMISPHERE && p == PHASE_HEMISPHERE);
}

void startRay() {
    if (!isTracing(phase) || traversing(ray) || SURFACES_WAIT && waits) return;
    ray.anyHit = phase == PHASE_SHADOW && !HAS_ALPHA;
    startTraversal(ray);
    ++rayCount;
}
