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

Traversal ray;
uint rayIndex;
uint raysLeft;
bool tracing; ///< `ray` is one of the buffer's
LaneTotals totals;

void takeResult() {
    const bool hit = ray.hitPrimitive != NO_PRIMITIVE;
    totals.hits += hit ? 1u : 0u;
    totals.distances += hit ? ray.tMax : 0.0;
    if (WRITE_DISTANCES) rayDistances[rayIndex] = hit ? ray.tMax : INFINITE_DISTANCE;
}

void startRay() {
    const uvec4 r0 = ROW(rayRows, 2u * rayIndex), r1 = ROW(rayRows, 2u * rayIndex + 1u);
    startTraversal(ray, uintBitsToFloat(r0.xyz), uintBitsToFloat(r1.xyz), 0.0,
                   uintBitsToFloat(r0.w), NO_PRIMITIVE, ANY_HIT);
}

/// Takes in the finished ray and starts the lane's next one, if there is one.
void serve() {
    if (tracing) {
        takeResult();
        --raysLeft;
        rayIndex += gl_WorkGroupSize.x;
    }
    tracing = raysLeft > 0u && rayIndex < dispatch.rayCount;
    if (tracing) startRay();
}

/// The rays of this group: those of its number, or the next chunk that no group has taken, where a
/// group is one subgroup (docs/kernel.md, "Both threads to the end").
uint takeChunk() {
    if (dispatch.chunkCount == 0u) return gl_WorkGroupID.x;
    uint chunk = 0u;
    if (subgroupElect()) chunk = atomicAdd(nextChunk, 1u);
    return subgroupBroadcastFirst(chunk);
}

void main() {
    // Neighbouring lanes take neighbouring rays at about the same time.
    const uint chunk = takeChunk();
    rayIndex = chunk * gl_WorkGroupSize.x * dispatch.raysPerLane + gl_LocalInvocationID.x;
    raysLeft = dispatch.chunkCount == 0u || chunk < dispatch.chunkCount ? dispatch.raysPerLane : 0u;
    totals = LaneTotals(0u, 0.0, 0u);
    tracing = false;
    startTraversal(ray, vec3(0.0), vec3(0.0), 0.0, 0.0, NO_PRIMITIVE, ANY_HIT); // done at once

    // Every exit is in a loop's header (docs/kernel.md, "Exits of loops").
    bool finished = false;
    uint iteration = 0u;
    while (!finished && iteration < dispatch.hardIterations) {
        const Ray prepared = makeRay(ray.origin, ray.direction);
        for (uint leg = 0u; leg < TRAVERSAL_LEGS; ++leg) {
            const Ray aimed = prepareLeg(ray, prepared);
            for (uint k = 0u; k < TRAVERSAL_STEPS; ++k)
                traversalStep(ray, aimed);
        }
        bool waiting = !traversing(ray);
        while (waiting) {
            serve();
            finished = !tracing;
            waiting = false;
        }
        ++iteration;
    }
    totals.unfinished = finished ? 0u : 1u;
    laneTotals[gl_GlobalInvocationID.x] = totals;
}
