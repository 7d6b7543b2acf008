#version 460
// The path kernel with the wavefront scheduler: the same functions as in pathtrace.comp, in stages that are kernels
// of their own. Paths lie in memory; each stage serves those in its queue and puts them into the queue of the next
// one (docs/theory/kernel.md, "Two schedulers"). A kernel that traces needs few registers, and its lanes all trace.
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_vote : require
#extension GL_KHR_shader_subgroup_ballot : require

#include "include/path_kernel.glsl"
#include "shared/wavefront_types.h"
#include "shared/path_fields.h"

layout(constant_id = SPEC_STAGE) const uint STAGE = STAGE_TRACE;

layout(set = 0, binding = BINDING_QUEUES, std430) buffer QueueBuffer {
    QueueHead heads[QUEUE_COUNT];
    uint queued[]; ///< numbers of paths, laneCount for each queue
};

const uint KEPT = ALWAYS;
#include "include/path_memory.glsl"

/// Puts this lane's path into a queue, if `wanted`. One atomic operation for a subgroup.
void enqueue(uint queue, bool wanted, PathSlot slot) {
    const uint laneCount = dispatches[firstPlace()].laneCount;
    const uvec4 those = subgroupBallot(wanted);
    const uint count = subgroupBallotBitCount(those);
    uint first = 0u;
    if (subgroupElect() && count > 0u) {
        first = atomicAdd(heads[queue].count, count);
        atomicMax(heads[queue].groups, (first + count + gl_WorkGroupSize.x - 1u) / gl_WorkGroupSize.x);
    }
    first = subgroupBroadcastFirst(first);
    if (wanted) queued[queue * laneCount + first + subgroupBallotExclusiveBitCount(those)] = slot.number;
}

uint countOf(bool those) { return subgroupBallotBitCount(subgroupBallot(those)); }

/// Sends a path on, by what it asks for. One without a ray passes through STAGE_TRACE untouched.
void sendOn(bool isThere, PathSlot slot, uint phase, uint rayQueue) {
    const bool departs = phase == PHASE_BOUNCE || phase == PHASE_NEXT;
    enqueue(QUEUE_DEPARTING, isThere && departs, slot);
    enqueue(rayQueue, isThere && !departs && phase != PHASE_FINISHED, slot);
}

/// That of the next round.
uint otherRayQueue(const Dispatch dispatch) { return QUEUE_RAYS + QUEUE_RAYS + 1u - dispatch.rayQueue; }

void beginPath(bool isThere, PathSlot slot) {
    PathState path;
    Job job;
    if (isThere) {
        loadPath(slot, path, job, BY_DEPART);
        path.phase = PHASE_NEXT;
        job.item = NO_ITEM;
        job.target = 0u;
        storePath(slot, path, job, BY_DEPART);
    }
    sendOn(isThere, slot, PHASE_NEXT, QUEUE_RAYS);
}

void stopPath(const Frame frame, bool isThere, PathSlot slot) {
    PathState path;
    Job job;
    job.item = NO_ITEM;
    path.phase = PHASE_FINISHED;
    if (isThere) loadPath(slot, path, job, BY_DEPART);
    const bool hasPixel = isThere && job.item != NO_ITEM;
    if (hasPixel) fetchPixelInHand(frame, path, job);
    if (hasPixel && !wantsPixel(path, job)) {
        const bool ends = endsSampleUnderWay(frame, path);
        job.target = samplesTaken(path) + (ends ? 1u : 0u);
        if (!ends) path.phase = PHASE_NEXT;
        storePath(slot, path, job, BY_DEPART);
    }
    sendOn(hasPixel, slot, path.phase, QUEUE_RAYS);
}

void departPath(const Given given, const Dispatch dispatch, bool isThere, PathSlot slot) {
    PathState path;
    Job job;
    path.phase = PHASE_FINISHED;
    job.sampleCount = 0u;
    if (isThere) {
        loadPath(slot, path, job, BY_DEPART);
        if (job.item != NO_ITEM) fetchPixelInHand(given.frame, path, job);
        changePixel(given.frame, dispatch.itemCount, path, job, dispatch.beginsNoSample == 0u);
        if (path.phase == PHASE_NEXT && job.item != NO_ITEM) storePixel(job.pixel, path.pixelState); // samplesBefore
        const bool hadSplit = !SPLITS || path.splitPoint.bounce != 0u;
        if (path.phase == PHASE_BOUNCE || path.phase == PHASE_NEXT && !wantsPixel(path, job)) depart(given, path);
        if (SEES && job.item != NO_ITEM) storeSeen(job.pixel, path.seen);
        storePath(slot, path, job, BY_DEPART);
        if (path.phase != PHASE_FINISHED && !hadSplit && path.splitPoint.bounce != 0u) storePath(slot, path, job, AT_SPLIT);
    }
    // One whose next pixel has all its samples already comes back in the next round.
    enqueue(dispatch.rayQueue, isThere && path.phase != PHASE_FINISHED, slot);
}

void tracePath(const Dispatch dispatch, bool isThere, PathSlot slot) {
    PathState path;
    Job job;
    job.busySteps = 0u;
    job.allSteps = 0u;
    Stack stack;
    path.phase = PHASE_FINISHED;
    endTraversal(path.ray);
    if (isThere) loadPath(slot, path, job, BY_TRACE);
    const bool traces = isTracing(path.phase);
    if (traces) startRay(path, stack);
    uint iteration = 0u;
    while (traversing(path.ray) && iteration < dispatch.hardIterations) {
        traverseSomeSteps(path, job, stack);
        ++iteration;
    }
    if (traversing(path.ray)) atomicAdd(status.overflowedItems, 1u);
    if (traces) storePath(slot, path, job, BY_TRACE);
    const uint rays = countOf(traces);
    if (subgroupElect()) atomicAdd(status.rays, rays);
    if (COUNT_STEPS) {
        atomicAdd(status.busySteps, job.busySteps);
        atomicAdd(status.allSteps, job.allSteps);
    }
}

/// A path that has ended where it had split comes back here, and the surface of the next branch is looked up as one
/// that a ray has met.
void followStoredPath(const Given given, const Dispatch dispatch, bool isThere, PathSlot slot) {
    PathState path;
    Job job;
    path.phase = PHASE_FINISHED;
    bool endsSample = false, isLit = false;
    if (isThere) {
        loadPath(slot, path, job, BY_FOLLOW);
        fetchPixelInHand(given.frame, path, job);
        const bool returns = branchIsOver(path);
        const bool arrives = path.phase == PHASE_PATH || returns || isThroughGlass(path);
        if (returns) loadPath(slot, path, job, AT_RETURN);
        // What has arrived sets up another surface; where the old one is needed late, it takes no registers before.
        const bool needsSurfaceNow = DIRECT_LIGHT == DIRECT_HEMISPHERE || LIGHT_THROUGH_GLASS;
        if (needsSurfaceNow && !arrives) loadPath(slot, path, job, AT_RESULT);
        bool isUnderWay = false;
        if (!returns) isUnderWay = goThroughMedium(given, path);
        MaterialPoint asked = askedPoint(path);
        if (returns) asked = materialPoint(path.splitPoint.surface);
        const bool goesOn = path.phase != PHASE_NEXT && !isUnderWay && takeInRay(given, path, asked);
        if (!needsSurfaceNow && !arrives) loadPath(slot, path, job, AT_RESULT);
        if (returns) nextBranch(path, path.found.parameters);
        isLit = goesOn && wantsDirectSample(given.frame, path);
        if (goesOn && !isLit) leaveDirectLight(given.frame, path);
        endsSample = goesOn && path.phase == PHASE_ENDED && !branchIsOver(path);
        if (endsSample) {
            path.pixelState = fetchPixel(job.pixel);
            finishSample(given.frame, path);
            storePixel(job.pixel, path.pixelState);
        }
        if (SEES) storeSeen(job.pixel, path.seen);
        storePath(slot, path, job, BY_FOLLOW);
        if (arrives || LIGHT_THROUGH_GLASS) storePath(slot, path, job, AT_ARRIVAL);
    }
    enqueue(QUEUE_LIT, isLit, slot);
    sendOn(isThere && !isLit, slot, path.phase, otherRayQueue(dispatch));
    const uint samples = countOf(endsSample);
    if (subgroupElect()) atomicAdd(status.samples, samples);
}

/// A light sample that brings nothing asks for no ray; the path goes on in the next round all the same.
void lightPath(const Given given, const Dispatch dispatch, bool isThere, PathSlot slot) {
    PathState path;
    Job job;
    if (isThere) {
        loadPath(slot, path, job, BY_LIGHT);
        fetchPixelInHand(given.frame, path, job);
        sampleDirect(given, path);
        storePath(slot, path, job, BY_LIGHT);
    }
    enqueue(otherRayQueue(dispatch), isThere, slot);
}

void main() {
    const Given given = findGiven();
    const Dispatch dispatch = dispatches[firstPlace()];
    const uint lane = gl_GlobalInvocationID.x;
    const PathSlot own = slotOf(lane);
    if (STAGE == STAGE_BEGIN) {
        beginPath(lane < dispatch.laneCount, own);
        return;
    }
    if (STAGE == STAGE_STOP) {
        stopPath(given.frame, lane < dispatch.laneCount, own);
        return;
    }
    const uint queue = STAGE == STAGE_DEPART ? QUEUE_DEPARTING : STAGE == STAGE_LIGHT ? QUEUE_LIT : dispatch.rayQueue;
    const bool isThere = lane < heads[queue].count;
    const uint number = isThere ? queued[queue * dispatch.laneCount + lane] : 0u;
    const PathSlot slot = slotOf(number);
    if (STAGE == STAGE_DEPART) departPath(given, dispatch, isThere, slot);
    if (STAGE == STAGE_TRACE) tracePath(dispatch, isThere, slot);
    if (STAGE == STAGE_FOLLOW) followStoredPath(given, dispatch, isThere, slot);
    if (STAGE == STAGE_LIGHT) lightPath(given, dispatch, isThere, slot);
}
