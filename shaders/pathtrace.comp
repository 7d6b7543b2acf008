#version 460
// The path kernel with the persistent scheduler: each lane takes pixels of the work list, one after the other,
// and all the samples that the list asks for of each. wavefront.comp is the other scheduler.
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_KHR_shader_subgroup_ballot : require

#include "include/path_kernel.glsl"
#include "shared/path_fields.h"

// A function, and not a constant: spirv-opt loses the order of constants that are made of so many others.
uint keptBetweenDispatches() { return KEPT_BETWEEN_DISPATCHES; }
#define KEPT keptBetweenDispatches()
#include "include/path_memory.glsl"

bool atWork(PathState path) { return path.phase != PHASE_FINISHED && !isSuspended(path.phase); }

/// Whether an eighth of the subgroup's lanes at work want another pixel (docs/theory/kernel.md,
/// "Leaving the inner loop together").
bool pixelsAreWanted(PathState path, Job job) {
    const uint wanting = subgroupBallotBitCount(subgroupBallot(wantsPixel(path, job)));
    return 8u * wanting >= subgroupBallotBitCount(subgroupBallot(atWork(path)));
}

/// Goes on where the last dispatch ended: with its pixel, and with the ray that it was about to trace.
void resume(const Frame frame, bool beginsNoSample, inout PathState path, inout Job job, PathSlot slot) {
    loadPath(slot, path, job, KEPT);
    bool goesOn = job.item != NO_ITEM && isSuspended(path.phase);
    const uint phase = path.phase & ~PHASE_SUSPENDED;
    job.sampleCount = 0u;
    takeUp(frame, path, job, job.item);
    path.phase = PHASE_NEXT;
    endTraversal(path.ray);
    if (beginsNoSample && job.item != NO_ITEM) {
        const bool isDropped = !endsSampleUnderWay(frame, path);
        job.target = samplesTaken(path) + (isDropped ? 0u : 1u);
        goesOn = goesOn && !isDropped;
    }
    if (goesOn && STOPS_BEFORE_ANY_RAY) path.phase = phase;
    if (goesOn && !STOPS_BEFORE_ANY_RAY) {
        const uint skipPlacement = path.ray.skipPlacement;
        trace(path, PHASE_PATH, path.ray.origin, path.ray.direction, 0.0, INFINITE_DISTANCE, path.ray.skipPrimitive);
        path.ray.skipPlacement = skipPlacement;
    }
}

/// Remembers the ray that was to be started; a camera ray that has passed nothing is simply begun anew.
void pause(PathState path, Job job, PathSlot slot) {
    if (!isSuspended(path.phase)) job.item = NO_ITEM;
    const bool isCameraRay = path.bounce == 0u && path.phase == (PHASE_SUSPENDED | PHASE_PATH);
    if (isCameraRay && !hasPassedSomething(path)) path.phase = PHASE_NEXT;
    storePath(slot, path, job, KEPT);
}

/// Starts the ray that a lane has asked for, or its next sample. Where time is up, the ray is put off to the next
/// dispatch, if what is kept of the path is enough to go on with it.
void startWork(const Given given, inout PathState path, inout Stack stack, Job job, bool late) {
    if (path.phase == PHASE_BOUNCE || path.phase == PHASE_NEXT && !wantsPixel(path, job)) depart(given, path);
    const bool mayBePutOff =
        STOPS_BEFORE_ANY_RAY ? isTracing(path.phase)
                             : path.phase == PHASE_PATH && !hasPassedSomething(path) && !isThroughGlass(path);
    if (late && mayBePutOff && !traversing(path.ray)) path.phase |= PHASE_SUSPENDED;
    startRay(path, stack);
}

/// Iterations between two looks at the count of all lanes' iterations.
const uint LOOK_INTERVAL = 64u;

/// Whether this lane is to start no further ray of a path. Where the host knows how many groups a
/// thread of the driver runs in turn, the n-th group of every thread is late when all lanes together
/// have done n groups' share of iterations (docs/theory/kernel.md, "Both threads to the end").
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
    if (isSuspended(path.phase)) atomicAdd(status.unfinishedItems, 1u);
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
    const Dispatch dispatch = dispatches[firstPlace()];
    const uint lane = gl_GlobalInvocationID.x;
    if (lane >= dispatch.laneCount) return;
    const PathSlot slot = slotOf(lane);
    path.rayCount = 0u;
    job.busySteps = 0u;
    job.allSteps = 0u;
    resume(given.frame, dispatch.beginsNoSample != 0u, path, job, slot);

    // The lanes of a subgroup leave the inner loop together, when enough of them want another pixel;
    // every exit is in a loop's header or at its end; and hardIterations keeps a dispatch finite on any device
    // (docs/theory/kernel.md, "Leaving the inner loop together", "Exits of loops", "The loop limit").
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
    pause(path, job, slot);
    putDown(given.frame, path, job);
    report(path, job);
}
