#version 460
// The path kernel with the persistent scheduler: each lane takes pixels of the work list, one after the other,
// and all the samples that the list asks for of each. wavefront.comp is the other scheduler.
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_KHR_shader_subgroup_ballot : require

#include "include/path_kernel.glsl"

layout(set = 0, binding = BINDING_SUSPENDED, std430) buffer SuspendedBuffer {
    SuspendedPath suspendedPaths[];
};
layout(set = 0, binding = BINDING_SPLITS, std430) buffer SplitBuffer {
    SuspendedSplit suspendedSplits[];
};

bool atWork(PathState path) { return path.phase != PHASE_FINISHED && path.phase != PHASE_SUSPENDED; }

/// Whether an eighth of the subgroup's lanes at work want another pixel (docs/kernel.md,
/// "Leaving the inner loop together").
bool pixelsAreWanted(PathState path, Job job) {
    const uint wanting = subgroupBallotBitCount(subgroupBallot(wantsPixel(path, job)));
    return 8u * wanting >= subgroupBallotBitCount(subgroupBallot(atWork(path)));
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

void resume(const Frame frame, bool beginsNoSample, inout PathState path, inout Job job, uint lane) {
    const SuspendedPath p = suspendedPaths[lane];
    job.sampleCount = 0u;
    takeUp(frame, path, job, p.item);
    path.phase = PHASE_NEXT;
    endTraversal(path.ray);
    bool isDropped = false;
    if (beginsNoSample && job.item != NO_ITEM) {
        isDropped = !endsSampleUnderWay(frame, path);
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
    if (samplesHaveWeights()) restoreFilterWeight(frame, path);
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
void startWork(const Given given, inout PathState path, inout Stack stack, Job job, bool late) {
    if (path.phase == PHASE_BOUNCE || path.phase == PHASE_NEXT && !wantsPixel(path, job)) depart(given, path);
    const bool mayBePutOff = !hasPassedSomething(path);
    if (late && path.phase == PHASE_PATH && !traversing(path.ray) && mayBePutOff) path.phase = PHASE_SUSPENDED;
    startRay(path, stack);
}

/// Iterations between two looks at the count of all lanes' iterations.
const uint LOOK_INTERVAL = 64u;

/// Whether this lane is to start no further ray of a path. Where the host knows how many groups a
/// thread of the driver runs in turn, the n-th group of every thread is late when all lanes together
/// have done n groups' share of iterations (docs/kernel.md, "Both threads to the end").
bool isLate(const Dispatch dispatch, uint iteration, uint sinceLastLook) {
    if (dispatch.groupsPerThread == 0u) return iteration >= dispatch.softIterations;
    const uint done = atomicAdd(status.iterations, sinceLastLook) + sinceLastLook;
    const uint groupsEnded = gl_WorkGroupID.x % dispatch.groupsPerThread + 1u;
    return iteration >= dispatch.softIterations ||
           iteration > 0u && done >= groupsEnded * dispatch.sharedIterations;
}

uint nextLook(const Dispatch dispatch, uint iteration, bool late) {
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
    Stack stack;
    clear(stack);
    const Given given = findGiven();
    const Dispatch dispatch = dispatchConstants;
    const uint lane = gl_GlobalInvocationID.x;
    if (lane >= dispatch.laneCount) return;
    path.rayCount = 0u;
    job.busySteps = 0u;
    job.allSteps = 0u;
    resume(given.frame, dispatch.beginsNoSample != 0u, path, job, lane);

    // The lanes of a subgroup leave the inner loop together, when enough of them want another pixel;
    // every exit is in a loop's header or at its end; and hardIterations keeps a dispatch finite on any device
    // (docs/kernel.md, "Leaving the inner loop together", "Exits of loops", "The loop limit").
    uint iteration = 0u;
    uint lastLook = 0u;
    while (atWork(path) && iteration < dispatch.hardIterations) {
        const bool late = subgroupAny(isLate(dispatch, iteration, iteration - lastLook));
        lastLook = iteration;
        const uint pause = nextLook(dispatch, iteration, late);
        changePixel(given.frame, dispatch.itemCount, path, job, !late && dispatch.beginsNoSample == 0u);
        bool pixelsWanted = false;
        while (!pixelsWanted && atWork(path) && iteration < pause) {
            startWork(given, path, stack, job, late);
            traverseSomeSteps(path, job, stack);
            ++iteration;
            if (!traversing(path.ray)) followPath(given, path);
            pixelsWanted = pixelsAreWanted(path, job);
        }
    }
    suspendedPaths[lane].bounce = SUSPENDED_NONE;
    suspendedPaths[lane].item = NO_ITEM;
    if (path.phase == PHASE_SUSPENDED) suspend(path, job, lane);
    putDown(given.frame, path, job);
    report(path, job);
}
