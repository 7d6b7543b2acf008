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

/// What a lane has in hands of the work list, and what it counts.
struct Job {
    uint item;        ///< of the work list; NO_ITEM: none
    uint pixel;       ///< of the item, in the film segment
    uint target;      ///< samples it shall have
    uint sampleCount; ///< taken in this dispatch
    uint busySteps, allSteps;
};

uint samplesTaken(PathState path) { return path.pixelState.count + path.pixelState.rejected; }

/// Is ready for a new sample, but this pixel has all of its own.
bool wantsPixel(PathState path, Job job) { return path.phase == PHASE_NEXT && (job.item == NO_ITEM || samplesTaken(path) >= job.target); }

void takeUp(inout PathState path, inout Job job, uint newItem) {
    job.item = newItem;
    if (job.item == NO_ITEM) return;
    const WorkItem work = fetchWorkItem(job.item);
    job.pixel = work.pixel;
    job.target = work.target;
    path.pixelState = fetchPixel(job.pixel);
    job.sampleCount -= samplesTaken(path);
    path.pixelAt = uvec2(work.column, work.row);
    path.pixelId = path.pixelAt.y * frame.width + path.pixelAt.x;
}

bool atWork(PathState path) { return path.phase != PHASE_FINISHED && path.phase != PHASE_SUSPENDED; }

/// Whether an eighth of the subgroup's lanes at work want another pixel (docs/kernel.md,
/// "Leaving the inner loop together").
bool pixelsAreWanted(PathState path, Job job) {
    const uint wanting = subgroupBallotBitCount(subgroupBallot(wantsPixel(path, job)));
    return 8u * wanting >= subgroupBallotBitCount(subgroupBallot(atWork(path)));
}

void putDown(inout PathState path, inout Job job) {
    if (job.item == NO_ITEM) return;
    if (frame.keepsValue != 0u && samplesTaken(path) >= job.target) path.pixelState.sum = path.radiance;
    storePixel(job.pixel, path.pixelState);
    job.sampleCount += samplesTaken(path);
    job.item = NO_ITEM;
}

/// When the pixel has all its samples, goes on with the next one that no lane has taken. No pixel
/// depends on which lane it falls to.
void changePixel(inout PathState path, inout Job job, bool mayGoOn) {
    if (!wantsPixel(path, job)) return;
    putDown(path, job);
    path.phase = PHASE_FINISHED;
    if (!mayGoOn) return;
    const uint taken = atomicAdd(status.nextItem, 1u);
    if (taken >= dispatch.itemCount) return;
    takeUp(path, job, taken);
    path.pixelState.samplesBefore = frame.firstSample + samplesTaken(path);
    path.phase = PHASE_NEXT;
}

/// Of random numbers (randomWords); no sample uses it.
const uint STOPPING_BLOCK = 0x7FFFFFFFu;

/// The render was stopped while this lane had a pixel in hand: is its sample under way to be ended, or
/// dropped? Samples that take long are under way more often than others, and are often brighter. A pixel
/// that has no other sample ends it and one that began in this pass drops it, which leaves its mean
/// without bias (Glynn and Heidelberger 1990); with samples of earlier passes the errors of ending and
/// dropping cancel, to the first order, where it is ended with the share of those in all (docs/estimator.md,
/// "A render that is stopped"). The choice knows nothing of the samples' values.
bool endsSampleUnderWay(PathState path) {
    const uint taken = frame.firstSample + samplesTaken(path);
    if (taken == 0u) return true;
    const uint word = pcg4d(uvec4(path.pixelId, taken, STOPPING_BLOCK, frame.seed)).x;
    return float(word >> 8u) * (1.0 / 16777216.0) * float(taken) < float(path.pixelState.samplesBefore);
}

void resumeSplit(inout PathState path, uint lane) {
    const SuspendedSplit s = suspendedSplits[lane];
    path.splitPoint.bounce = s.bounce;
    path.splitPoint.throughput = s.throughput;
    path.splitPoint.surface = SurfacePoint(s.position, s.error, s.geometric, s.shading, s.wo,
                                      s.outside != 0u, s.material, s.skipPrimitive, s.lift
                                      , s.primitive, vec2(s.b1, s.b2), vec4(0.0), vec3(0.0)
                                      , s.placement
    );
    if (TANGENT_FRAMES)
        path.splitPoint.surface.tangent =
            tangentAt(path.splitPoint.surface, shadingNormal(path.splitPoint.surface));
    if (sceneHasCoatNormals()) path.splitPoint.surface.coat = coatNormal(path.splitPoint.surface);
    path.branchesLeft = s.branchesLeft;
    path.splitPoint.medium = s.medium;
}

void suspendSplit(PathState path, uint lane) {
    const SurfacePoint p = path.splitPoint.surface;
    suspendedSplits[lane] =
        SuspendedSplit(p.position, path.splitPoint.bounce, p.geometric, p.material, p.shading,
                       p.skipPrimitive, p.wo, p.lift, path.splitPoint.throughput, p.error,
                       p.outside ? 1u : 0u, path.branchesLeft, p.weights.x, p.weights.y, path.splitPoint.medium,
                       p.placement, p.primitive, 0u);
}

void resume(inout PathState path, inout Job job, uint lane) {
    const SuspendedPath p = suspendedPaths[lane];
    job.sampleCount = 0u;
    takeUp(path, job, p.item);
    path.phase = PHASE_NEXT;
    endTraversal(path.ray);
    clearStack();
    bool isDropped = false;
    if (dispatch.beginsNoSample != 0u && job.item != NO_ITEM) {
        isDropped = !endsSampleUnderWay(path);
        job.target = samplesTaken(path) + (isDropped ? 0u : 1u);
    }
    if (isDropped || p.bounce == SUSPENDED_NONE) return;
    path.bounce = p.bounce;
    path.throughput = p.throughput;
    path.radiance = p.radiance;
    path.countsEmission = p.emission != SUSPENDED_NO_EMISSION;
    path.bouncePdf = max(p.emission, 0.0);
    path.arrivalNumbers = p.arrivalNumbers;
    path.departureNormal = p.departureNormal;
    path.medium = p.medium;
    if (samplesHaveWeights()) restoreFilterWeight(path);
    if (SPLITS) resumeSplit(path, lane);
    trace(path, PHASE_PATH, p.origin, p.direction, 0.0, INFINITE_DISTANCE, p.skipPrimitive);
    path.ray.skipPlacement = p.skipPlacement;
}

/// Remembers the bounce ray that was to be started; a camera ray is simply begun anew.
void suspend(PathState path, Job job, uint lane) {
    SuspendedPath p;
    p.origin = path.ray.origin;
    p.bounce = path.bounce == 0u ? SUSPENDED_NONE : path.bounce;
    p.direction = path.ray.direction;
    p.skipPrimitive = path.ray.skipPrimitive;
    p.throughput = path.throughput;
    p.emission = path.countsEmission ? path.bouncePdf : SUSPENDED_NO_EMISSION;
    p.radiance = path.radiance;
    p.item = job.item;
    p.arrivalNumbers = path.arrivalNumbers;
    p.departureNormal = path.departureNormal;
    p.skipPlacement = NO_PLACEMENT;
    p.medium = path.medium;
    p.skipPlacement = path.ray.skipPlacement;
    suspendedPaths[lane] = p;
    if (SPLITS) suspendSplit(path, lane);
}

/// Starts the ray that a lane has asked for, or its next sample. A lane about to trace a path ray may
/// put it off to the next dispatch; in any other phase too much would have to be remembered.
void startWork(inout PathState path, Job job, bool late) {
    if (path.phase == PHASE_BOUNCE || path.phase == PHASE_NEXT && !wantsPixel(path, job)) depart(path);
    bool mayBePutOff = true;
    mayBePutOff = !hasPassedSomething(path);
    if (late && path.phase == PHASE_PATH && !traversing(path.ray) && mayBePutOff) path.phase = PHASE_SUSPENDED;
    startRay(path);
}

/// What follows from the ray is worked out anew in each pass, not kept beside it (docs/kernel.md,
/// "Nothing is moved out of loops").
void traverseSomeSteps(inout PathState path, inout Job job) {
    const Ray prepared = makeRay(path.ray.origin, path.ray.direction);
    for (uint leg = 0u; leg < TRAVERSAL_LEGS; ++leg) {
        const Ray aimed = prepareLeg(path.ray, prepared);
        for (uint k = 0u; k < TRAVERSAL_STEPS; ++k) {
            if (COUNT_STEPS) job.busySteps += traversing(path.ray) ? 1u : 0u;
            traversalStep(path.ray, aimed);
        }
        if (COUNT_STEPS) job.allSteps += TRAVERSAL_STEPS;
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

void report(PathState path, Job job) {
    if (path.phase == PHASE_SUSPENDED) atomicAdd(status.unfinishedItems, 1u);
    if (atWork(path)) atomicAdd(status.overflowedItems, 1u);
    atomicAdd(status.rays, path.rayCount);
    atomicAdd(status.samples, job.sampleCount);
    if (COUNT_STEPS) {
        atomicAdd(status.busySteps, job.busySteps);
        atomicAdd(status.allSteps, job.allSteps);
    }
}

void main() {
    PathState path;
    Job job;
    frame = frameBuffer;
    dispatch = dispatchConstants;
    findPictureGrid();
    findOnlyLight();
    if (GAP_PROPOSAL) findGap();
    const uint lane = gl_GlobalInvocationID.x;
    if (lane >= dispatch.laneCount) return;
    path.rayCount = 0u;
    job.busySteps = 0u;
    job.allSteps = 0u;
    resume(path, job, lane);

    // The lanes of a subgroup leave the inner loop together, when enough of them want another pixel;
    // every exit is in a loop's header or at its end; and hardIterations keeps a dispatch finite on any device
    // (docs/kernel.md, "Leaving the inner loop together", "Exits of loops", "The loop limit").
    uint iteration = 0u;
    uint lastLook = 0u;
    while (atWork(path) && iteration < dispatch.hardIterations) {
        const bool late = subgroupAny(isLate(iteration, iteration - lastLook));
        lastLook = iteration;
        const uint pause = nextLook(iteration, late);
        changePixel(path, job, !late && dispatch.beginsNoSample == 0u);
        bool pixelsWanted = false;
        while (!pixelsWanted && atWork(path) && iteration < pause) {
            startWork(path, job, late);
            traverseSomeSteps(path, job);
            ++iteration;
            if (!traversing(path.ray)) followPath(path);
            pixelsWanted = pixelsAreWanted(path, job);
        }
    }
    suspendedPaths[lane].bounce = SUSPENDED_NONE;
    suspendedPaths[lane].item = NO_ITEM;
    if (path.phase == PHASE_SUSPENDED) suspend(path, job, lane);
    putDown(path, job);
    report(path, job);
}
