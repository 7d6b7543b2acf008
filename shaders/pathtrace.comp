#version 460
// The path kernel: each lane takes pixels of the work list, one after the other, and all the samples
// that the list asks for of each.
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_KHR_shader_subgroup_ballot : require

#include "shared/interface.h"
#include "shared/scene_types.h"
#include "shared/render_types.h"
#include "shared/texture_types.h"

#include "include/specialisation.glsl"
#include "include/fetch.glsl"
#include "include/film.glsl"

layout(set = 0, binding = BINDING_FRAME, std140) uniform FrameBuffer { Frame frameBuffer; };
layout(set = 0, binding = BINDING_SUSPENDED, std430) buffer SuspendedBuffer {
    SuspendedPath suspendedPaths[];
};
layout(set = 0, binding = BINDING_SPLITS, std430) buffer SplitBuffer {
    SuspendedSplit suspendedSplits[];
};
layout(set = 0, binding = BINDING_STATUS, std430) buffer StatusBuffer { DispatchStatus status; };
layout(push_constant) uniform DispatchConstants { Dispatch dispatchConstants; };

// Uniforms are read once, before all loops (docs/kernel.md, "Nothing is moved out of loops").
Frame frame;
Dispatch dispatch;

#include "include/numerics.glsl"
#include "include/random.glsl"
#include "include/intersect.glsl"
#include "include/traverse.glsl"
#include "include/camera.glsl"
#include "include/warps.glsl"
#include "include/pixel_filter.glsl"
#include "include/cs184.glsl"
#include "include/surface.glsl"
#include "bsdf/bsdf.glsl"
#include "include/material_detail.glsl"
#include "include/relief.glsl"
#include "lights/lights.glsl"
#include "include/mis.glsl"
#include "include/gap_proposal.glsl"
#include "include/two_sides.glsl"
#include "include/medium.glsl"
#include "include/accumulate.glsl"
#include "include/path.glsl"

uint item; ///< of the work list, in this lane's hands; NO_ITEM: none
uint pixel; ///< of the item, in the film segment
uint target; ///< samples it shall have
uint sampleCount; ///< taken in this dispatch
uint busySteps, allSteps;

uint samplesTaken() { return pixelState.count + pixelState.rejected; }

/// Is ready for a new sample, but this pixel has all of its own.
bool wantsPixel() { return phase == PHASE_NEXT && (item == NO_ITEM || samplesTaken() >= target); }

void takeUp(uint newItem) {
    item = newItem;
    if (item == NO_ITEM) return;
    const WorkItem work = fetchWorkItem(item);
    pixel = work.pixel;
    target = work.target;
    pixelState = fetchPixel(pixel);
    sampleCount -= samplesTaken();
    pixelAt = uvec2(work.column, work.row);
    pixelId = pixelAt.y * frame.width + pixelAt.x;
}

bool atWork() { return phase != PHASE_FINISHED && phase != PHASE_SUSPENDED; }

/// Whether an eighth of the subgroup's lanes at work want another pixel (docs/kernel.md,
/// "Leaving the inner loop together").
bool pixelsAreWanted() {
    const uint wanting = subgroupBallotBitCount(subgroupBallot(wantsPixel()));
    return 8u * wanting >= subgroupBallotBitCount(subgroupBallot(atWork()));
}

/// Whether as many of the subgroup's lanes wait at surfaces as are waited for. A dispatch that is to end has a
/// limit for its iterations, which is why nothing is waited for then: with many light samples each would wait anew.
bool enoughSurfacesWait() {
    const uint waiting = subgroupBallotBitCount(subgroupBallot(waits));
    return WAITING_PART * waiting >= subgroupBallotBitCount(subgroupBallot(atWork()));
}

void putDown() {
    if (item == NO_ITEM) return;
    if (frame.keepsValue != 0u && samplesTaken() >= target) pixelState.sum = radiance;
    storePixel(pixel, pixelState);
    sampleCount += samplesTaken();
    item = NO_ITEM;
}

/// When the pixel has all its samples, goes on with the next one that no lane has taken. No pixel
/// depends on which lane it falls to.
void changePixel(bool mayGoOn) {
    if (!wantsPixel()) return;
    putDown();
    phase = PHASE_FINISHED;
    if (!mayGoOn) return;
    const uint taken = atomicAdd(status.nextItem, 1u);
    if (taken >= dispatch.itemCount) return;
    takeUp(taken);
    pixelState.samplesBefore = frame.firstSample + samplesTaken();
    phase = PHASE_NEXT;
}

/// Of random numbers (randomWords); no sample uses it.
const uint STOPPING_BLOCK = 0x7FFFFFFFu;

/// The render was stopped while this lane had a pixel in hand: is its sample under way to be ended, or
/// dropped? Samples that take long are under way more often than others, and are often brighter. A pixel
/// that has no other sample ends it and one that began in this pass drops it, which leaves its mean
/// without bias (Glynn and Heidelberger 1990); with samples of earlier passes the errors of ending and
/// dropping cancel, to the first order, where it is ended with the share of those in all (docs/estimator.md,
/// "A render that is stopped"). The choice knows nothing of the samples' values.
bool endsSampleUnderWay() {
    const uint taken = frame.firstSample + samplesTaken();
    if (taken == 0u) return true;
    const uint word = pcg4d(uvec4(pixelId, taken, STOPPING_BLOCK, frame.seed)).x;
    return float(word >> 8u) * (1.0 / 16777216.0) * float(taken) < float(pixelState.samplesBefore);
}

void resumeSplit(uint lane) {
    const SuspendedSplit s = suspendedSplits[lane];
    splitPoint.bounce = s.bounce;
    splitPoint.throughput = s.throughput;
    splitPoint.surface = SurfacePoint(s.position, s.error, s.geometric, s.shading, s.wo,
                                      s.outside != 0u, s.material, s.skipPrimitive, s.lift
                                      , s.primitive, vec2(s.b1, s.b2), vec4(0.0), vec3(0.0)
                                      , s.placement
    );
    if (TANGENT_FRAMES)
        splitPoint.surface.tangent =
            tangentAt(splitPoint.surface, shadingNormal(splitPoint.surface));
    if (sceneHasCoatNormals()) splitPoint.surface.coat = coatNormal(splitPoint.surface);
    branchesLeft = s.branchesLeft;
    splitPoint.medium = s.medium;
}

void suspendSplit(uint lane) {
    const SurfacePoint p = splitPoint.surface;
    const uint medium = splitPoint.medium, primitive = p.primitive;
    const vec2 weights = p.weights;
    const uint placement = p.placement;
    suspendedSplits[lane] =
        SuspendedSplit(p.position, splitPoint.bounce, p.geometric, p.material, p.shading,
                       p.skipPrimitive, p.wo, p.lift, splitPoint.throughput, p.error,
                       p.outside ? 1u : 0u, branchesLeft, weights.x, weights.y, medium, placement, primitive, 0u);
}

void resume(uint lane) {
    const SuspendedPath p = suspendedPaths[lane];
    sampleCount = 0u;
    takeUp(p.item);
    phase = PHASE_NEXT;
    endTraversal(ray);
    clearStack();
    bool isDropped = false;
    if (dispatch.beginsNoSample != 0u && item != NO_ITEM) {
        isDropped = !endsSampleUnderWay();
        target = samplesTaken() + (isDropped ? 0u : 1u);
    }
    if (isDropped || p.bounce == SUSPENDED_NONE) return;
    bounce = p.bounce;
    throughput = p.throughput;
    radiance = p.radiance;
    countsEmission = p.emission != SUSPENDED_NO_EMISSION;
    bouncePdf = max(p.emission, 0.0);
    arrivalNumbers = p.arrivalNumbers;
    departureNormal = p.departureNormal;
    medium = p.medium;
    if (samplesHaveWeights()) restoreFilterWeight();
    if (SPLITS) resumeSplit(lane);
    trace(PHASE_PATH, p.origin, p.direction, 0.0, INFINITE_DISTANCE, p.skipPrimitive);
    ray.skipPlacement = p.skipPlacement;
}

/// Remembers the bounce ray that was to be started; a camera ray is simply begun anew.
void suspend(uint lane) {
    SuspendedPath p;
    p.origin = ray.origin;
    p.bounce = bounce == 0u ? SUSPENDED_NONE : bounce;
    p.direction = ray.direction;
    p.skipPrimitive = ray.skipPrimitive;
    p.throughput = throughput;
    p.emission = countsEmission ? bouncePdf : SUSPENDED_NO_EMISSION;
    p.radiance = radiance;
    p.item = item;
    p.arrivalNumbers = arrivalNumbers;
    p.departureNormal = departureNormal;
    p.skipPlacement = NO_PLACEMENT;
    p.medium = medium;
    p.skipPlacement = ray.skipPlacement;
    suspendedPaths[lane] = p;
    if (SPLITS) suspendSplit(lane);
}

/// Starts the ray that a lane has asked for, or its next sample. A lane about to trace a path ray may
/// put it off to the next dispatch; in any other phase too much would have to be remembered.
void startWork(bool late) {
    if (phase == PHASE_BOUNCE || phase == PHASE_NEXT && !wantsPixel()) depart();
    bool mayBePutOff = true;
    mayBePutOff = !hasPassedSomething();
    if (late && phase == PHASE_PATH && !traversing(ray) && mayBePutOff) phase = PHASE_SUSPENDED;
    startRay();
}

/// What follows from the ray is worked out anew in each pass, not kept beside it (docs/kernel.md,
/// "Nothing is moved out of loops").
void traverseSomeSteps() {
    const Ray prepared = makeRay(ray.origin, ray.direction);
    for (uint leg = 0u; leg < TRAVERSAL_LEGS; ++leg) {
        const Ray aimed = prepareLeg(ray, prepared);
        for (uint k = 0u; k < TRAVERSAL_STEPS; ++k) {
            if (COUNT_STEPS) busySteps += traversing(ray) ? 1u : 0u;
            traversalStep(ray, aimed);
        }
        if (COUNT_STEPS) allSteps += TRAVERSAL_STEPS;
    }
}

/// Iterations between two looks at the count of all lanes' iterations.
const uint LOOK_INTERVAL = 64u;

/// Whether this lane is to start no further ray of a path. Where the host knows how many groups a
/// thread of the driver runs in turn, the n-th group of every thread is late when all lanes together
/// have done n groups' share of iterations (docs/kernel.md, "Both threads to the end").
bool isLate(uint iteration, uint sinceLastLook) {
    if (dispatch.groupsPerThread == 0u) return iteration >= dispatch.softIterations;
    const uint done = atomicAdd(status.iterations, sinceLastLook) + sinceLastLook;
    const uint groupsEnded = gl_WorkGroupID.x % dispatch.groupsPerThread + 1u;
    return iteration >= dispatch.softIterations ||
           iteration > 0u && done >= groupsEnded * dispatch.sharedIterations;
}

uint nextLook(uint iteration, bool late) {
    if (late) return dispatch.hardIterations;
    if (dispatch.groupsPerThread == 0u) return dispatch.softIterations;
    return min(dispatch.softIterations, iteration + LOOK_INTERVAL);
}

void report() {
    if (phase == PHASE_SUSPENDED) atomicAdd(status.unfinishedItems, 1u);
    if (atWork()) atomicAdd(status.overflowedItems, 1u);
    atomicAdd(status.rays, rayCount);
    atomicAdd(status.samples, sampleCount);
    if (COUNT_STEPS) {
        atomicAdd(status.busySteps, busySteps);
        atomicAdd(status.allSteps, allSteps);
    }
}

void main() {
    frame = frameBuffer;
    dispatch = dispatchConstants;
    findPictureGrid();
    findOnlyLight();
    if (GAP_PROPOSAL) findGap();
    const uint lane = gl_GlobalInvocationID.x;
    if (lane >= dispatch.laneCount) return;
    rayCount = 0u;
    busySteps = 0u;
    waits = false;
    allSteps = 0u;
    resume(lane);

    // The lanes of a subgroup leave the inner loop together, when enough of them want another pixel;
    // every exit is in a loop's header or at its end; and hardIterations keeps a dispatch finite on any device
    // (docs/kernel.md, "Leaving the inner loop together", "Exits of loops", "The loop limit").
    uint iteration = 0u;
    uint lastLook = 0u;
    while (atWork() && iteration < dispatch.hardIterations) {
        const bool late = subgroupAny(isLate(iteration, iteration - lastLook));
        lastLook = iteration;
        const uint pause = nextLook(iteration, late);
        changePixel(!late && dispatch.beginsNoSample == 0u);
        bool pixelsWanted = false;
        while (!pixelsWanted && atWork() && iteration < pause) {
            bool staysFree;
            do {
                startWork(late);
                traverseSomeSteps();
                if (SURFACES_WAIT && !traversing(ray)) followFreePath();
                ++iteration;
                staysFree = SURFACES_WAIT && !late && iteration < pause && !pixelsAreWanted() && !enoughSurfacesWait();
            } while (staysFree);
            if (SURFACES_WAIT ? waits : !traversing(ray)) followPath();
            waits = false;
            pixelsWanted = pixelsAreWanted();
        }
    }
    suspendedPaths[lane].bounce = SUSPENDED_NONE;
    suspendedPaths[lane].item = NO_ITEM;
    if (phase == PHASE_SUSPENDED) suspend(lane);
    putDown();
    report();
}
