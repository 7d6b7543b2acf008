// What both schedulers of the path kernel have in common (pathtrace.comp, wavefront.comp): what is bound, the
// functions of a path, and the pixels of the work list.

#include "shared/interface.h"
#include "shared/scene_types.h"
#include "shared/render_types.h"
#include "shared/texture_types.h"
#include "shared/guide_types.h"

#include "include/specialisation.glsl"
#include "include/fetch.glsl"
#include "include/film.glsl"

layout(set = 0, binding = BINDING_FRAME, std140) uniform FrameBuffer { Frame frames[1]; };
layout(set = 0, binding = BINDING_STATUS, std430) buffer StatusBuffer { DispatchStatus status; };
layout(push_constant) uniform DispatchConstants { Dispatch dispatches[1]; };

/// 0, which no compiler knows: there are not so many workgroups. Constants of a buffer are read at this place of an array
/// of one. Lavapipe makes a kernel anew for the values of constants whose places it knows (docs/theory/kernel.md,
/// "Constants").
uint firstPlace() { return gl_WorkGroupID.x >> 31; }

#include "include/given.glsl"
#include "include/numerics.glsl"
#include "include/random.glsl"
#include "include/intersect.glsl"
#include "include/traverse.glsl"
#include "include/camera.glsl"
#include "include/warps.glsl"
#include "include/pixel_filter.glsl"
#include "include/conventions.glsl"
#include "include/surface.glsl"
#include "closures/bsdf.glsl"
#include "include/material_detail.glsl"
#include "include/relief.glsl"
#include "include/mixture.glsl"
#include "include/guide.glsl"
#include "lights/lights.glsl"
#include "include/gap_proposal.glsl"
#include "include/occluders.glsl"
#include "include/shadow_map.glsl"
#include "include/two_sides.glsl"
#include "include/aimed_bounces.glsl"
#include "include/medium.glsl"
#include "include/clear_glass.glsl"
#include "include/mis.glsl"
#include "include/accumulate.glsl"
#include "include/path.glsl"

Given findGiven() {
    Given given;
    given.frame = frames[firstPlace()];
    given.grid = pictureGrid(given.frame);
    given.onlyLight = findOnlyLight();
    given.roots = findRoots(given.frame);
    given.gap = findGap(given.frame, given.onlyLight);
    for (uint i = 0u; i < OCCLUDERS; ++i)
        given.occluders.all[i] = occluderOf(frames[dispatches[0].framePlace], i);
    for (uint i = 0u; i < PORTALS; ++i)
        given.portals.all[i] = portalOf(frames[dispatches[0].framePlace], i);
    if (HAS_AMBIENT) given.sky = fetchLightRows(0u);
    if (SHADOW_MAP) given.shadow = shadowMapOf(frames[dispatches[0].framePlace]);
    return given;
}

/// What a lane has in hand of the work list, and what it counts.
struct Job {
    uint item;        ///< of the work list; NO_ITEM: none
    uint pixel;       ///< of the item, in the film segment
    uint target;      ///< samples it shall have
    uint sampleCount; ///< taken in this dispatch
    uint busySteps, allSteps;
};

/// Is ready for a new sample, but this pixel has all of its own.
bool wantsPixel(PathState path, Job job) { return path.phase == PHASE_NEXT && (job.item == NO_ITEM || samplesTaken(path) >= job.target); }

/// Fetches the pixel of job.item. Returns how many samples the work list wants of it.
uint fetchPixelInHand(const Frame frame, inout PathState path, inout Job job) {
    const WorkItem work = fetchWorkItem(job.item);
    job.pixel = work.pixel;
    path.pixelState = fetchPixel(job.pixel);
    path.strand = STRANDS == 0u ? 0u : job.pixel % STRANDS;
    path.pixelAt = uvec2(work.column, work.row);
    path.pixelId = path.pixelAt.y * frame.width + path.pixelAt.x;
    if (SEES) path.seen = fetchSeen(job.pixel);
    return work.target;
}

void takeUp(const Frame frame, inout PathState path, inout Job job, uint newItem) {
    job.item = newItem;
    if (job.item == NO_ITEM) return;
    job.target = fetchPixelInHand(frame, path, job);
    job.sampleCount -= samplesTaken(path);
}

void putDown(const Frame frame, inout PathState path, inout Job job) {
    if (job.item == NO_ITEM) return;
    if (frame.keepsValue != 0u && samplesTaken(path) >= job.target) path.pixelState.sum = path.radiance;
    storePixel(job.pixel, path.pixelState);
    if (SEES) storeSeen(job.pixel, path.seen);
    job.sampleCount += samplesTaken(path);
    job.item = NO_ITEM;
}

/// Samples that the pixel has, of all blocks and strands: the others have about as many as this one.
uint samplesOfPixel(const Frame frame, PathState path) {
    return frame.firstSample + (STRANDS == 0u ? 1u : STRANDS) * samplesTaken(path);
}

/// When the pixel has all its samples, goes on with the next one that no lane has taken. No pixel
/// depends on which lane it falls to.
void changePixel(const Frame frame, uint itemCount, inout PathState path, inout Job job, bool mayGoOn) {
    if (!wantsPixel(path, job)) return;
    putDown(frame, path, job);
    path.phase = PHASE_FINISHED;
    if (!mayGoOn) return;
    const uint taken = atomicAdd(status.nextItem, 1u);
    if (taken >= itemCount) return;
    takeUp(frame, path, job, taken);
    path.pixelState.samplesBefore = samplesOfPixel(frame, path);
    path.phase = PHASE_NEXT;
}

/// The render was stopped while this lane had a pixel in hand: is its sample under way to be ended, or
/// dropped? Samples that take long are under way more often than others, and are often brighter. A pixel
/// that has no other sample ends it and one that began in this pass drops it, which leaves its mean
/// without bias (Glynn and Heidelberger 1990); with samples of earlier passes, or of other strands, the errors of
/// ending and dropping cancel, to the first order, where it is dropped with the share of what this strand has taken in
/// this pass (docs/theory/noise.md, "A render that is stopped"). The choice knows nothing of the samples' values.
bool endsSampleUnderWay(const Frame frame, PathState path) {
    const uint taken = samplesOfPixel(frame, path);
    if (taken == 0u) return true;
    const uint word = pcg4d(uvec4(path.pixelId, sampleIndex(frame, path), STOPPING_BLOCK, frame.seed)).x;
    float others = float(path.pixelState.samplesBefore), all = float(taken);
    if (STRANDS != 0u) {
        others += float(STRANDS - 1u) * all;
        all *= float(STRANDS);
    }
    return float(word >> 8u) * (1.0 / 16777216.0) * all < others;
}

/// What follows from the ray is worked out anew in each pass, not kept beside it (docs/theory/kernel.md,
/// "Nothing is moved out of loops").
void traverseSomeSteps(inout PathState path, inout Job job, inout Stack stack) {
    const Ray prepared = makeRay(path.ray.origin, path.ray.direction);
    for (uint leg = 0u; leg < TRAVERSAL_LEGS; ++leg) {
        const Ray aimed = prepareLeg(path.ray, prepared);
        for (uint k = 0u; k < TRAVERSAL_STEPS; ++k) {
            if (COUNT_STEPS) job.busySteps += traversing(path.ray) ? 1u : 0u;
            traversalStep(path.ray, stack, aimed);
        }
        if (COUNT_STEPS) job.allSteps += TRAVERSAL_STEPS;
        testWaitingSphere(path.ray, prepared);
    }
}
