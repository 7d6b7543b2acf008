#version 460
// Traces a buffer of rays and does nothing else: `stromboli bench` measures traversal with it. Same
// traversal code and the same shape of loop as the path kernel: a number of steps, then a service
// pass in which lanes whose rays are done take their next one.
#extension GL_GOOGLE_include_directive : require
#extension GL_KHR_shader_subgroup_ballot : require

#include "shared/interface.h"
#include "shared/scene_types.h"
#include "shared/ray_types.h"

#include "include/specialisation.glsl"
layout(constant_id = SPEC_ANY_HIT) const bool ANY_HIT = false;
layout(constant_id = SPEC_WRITE_DISTANCES) const bool WRITE_DISTANCES = false;

#include "include/fetch.glsl"

SCENE_BUFFER(BINDING_RAYS, rayRows)
layout(set = 0, binding = BINDING_LANE_TOTALS, std430) buffer TotalsBuffer {
    uint nextChunk;
    LaneTotals laneTotals[];
};
layout(set = 0, binding = BINDING_RAY_DISTANCES, std430) writeonly buffer DistanceBuffer {
    float rayDistances[];
};
layout(push_constant) uniform DispatchConstants { RayDispatch dispatch; };

#include "include/numerics.glsl"
#include "include/intersect.glsl"
#include "include/traverse.glsl"

/// What a lane knows of its rays.
struct Tracer {
    Traversal ray;
    uint rayIndex;
    uint raysLeft;
    bool tracing; ///< `ray` is one of the buffer's
    LaneTotals totals;
};

void takeResult(inout Tracer lane) {
    const bool hit = lane.ray.hitPrimitive != NO_PRIMITIVE;
    lane.totals.hits += hit ? 1u : 0u;
    lane.totals.distances += hit ? lane.ray.tMax : 0.0;
    if (WRITE_DISTANCES) rayDistances[lane.rayIndex] = hit ? lane.ray.tMax : INFINITE_DISTANCE;
}

void startRay(inout Tracer lane, inout Stack stack) {
    const uvec4 r0 = ROW(rayRows, 2u * lane.rayIndex), r1 = ROW(rayRows, 2u * lane.rayIndex + 1u);
    startTraversal(lane.ray, stack, uintBitsToFloat(r0.xyz), uintBitsToFloat(r1.xyz), 0.0,
                   uintBitsToFloat(r0.w), NO_PRIMITIVE, ANY_HIT);
}

/// Takes in the finished ray and starts the lane's next one, if there is one.
void serve(inout Tracer lane, inout Stack stack) {
    if (lane.tracing) {
        takeResult(lane);
        --lane.raysLeft;
        lane.rayIndex += gl_WorkGroupSize.x;
    }
    lane.tracing = lane.raysLeft > 0u && lane.rayIndex < dispatch.rayCount;
    if (lane.tracing) startRay(lane, stack);
}

/// The rays of this group: those of its number, or the next chunk that no group has taken, where a
/// group is one subgroup (docs/theory/kernel.md, "Both threads to the end").
uint takeChunk() {
    if (dispatch.chunkCount == 0u) return gl_WorkGroupID.x;
    uint chunk = 0u;
    if (subgroupElect()) chunk = atomicAdd(nextChunk, 1u);
    return subgroupBroadcastFirst(chunk);
}

void main() {
    Tracer lane;
    Stack stack;
    // Neighbouring lanes take neighbouring rays at about the same time.
    const uint chunk = takeChunk();
    lane.rayIndex = chunk * gl_WorkGroupSize.x * dispatch.raysPerLane + gl_LocalInvocationID.x;
    lane.raysLeft = dispatch.chunkCount == 0u || chunk < dispatch.chunkCount ? dispatch.raysPerLane : 0u;
    lane.totals = LaneTotals(0u, 0.0, 0u);
    lane.tracing = false;
    startTraversal(lane.ray, stack, vec3(0.0), vec3(0.0), 0.0, 0.0, NO_PRIMITIVE, ANY_HIT); // done at once

    // Every exit is in a loop's header (docs/theory/kernel.md, "Exits of loops").
    bool finished = false;
    uint iteration = 0u;
    while (!finished && iteration < dispatch.hardIterations) {
        const Ray prepared = makeRay(lane.ray.origin, lane.ray.direction);
        for (uint leg = 0u; leg < TRAVERSAL_LEGS; ++leg) {
            const Ray aimed = prepareLeg(lane.ray, prepared);
            for (uint k = 0u; k < TRAVERSAL_STEPS; ++k)
                traversalStep(lane.ray, stack, aimed);
            testWaitingSphere(lane.ray, prepared);
        }
        bool waiting = !traversing(lane.ray);
        while (waiting) {
            serve(lane, stack);
            finished = !lane.tracing;
            waiting = false;
        }
        ++iteration;
    }
    lane.totals.unfinished = finished ? 0u : 1u;
    laneTotals[gl_GlobalInvocationID.x] = lane.totals;
}
