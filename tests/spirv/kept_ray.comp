#version 460
// Which parts of a ray that a path asks for are found again in memory: by the next dispatch of the persistent scheduler,
// and by the stage that traces it. Each part has its bit, in the order of partsOf().
#extension GL_GOOGLE_include_directive : require

#include "include/path_kernel.glsl"
#include "shared/path_fields.h"
// A function, for the reason that pathtrace.comp has.
uint keptBetweenDispatches() { return KEPT_BETWEEN_DISPATCHES; }
#define KEPT keptBetweenDispatches()
#include "include/path_memory.glsl"

void setRay(inout PathState path, vec3 origin, vec3 direction, uint number, float distance) {
    path.ray.origin = origin;
    path.ray.direction = direction;
    path.ray.skipPrimitive = number;
    path.ray.skipPlacement = number + 1u;
    path.ray.passed = number + 2u;
    path.ray.passedPlacement = number + 3u;
    path.ray.tMin = distance;
    path.ray.tMax = distance + 1.0;
}

uint partsOf(PathState path, PathState other) {
    return uint(path.ray.origin == other.ray.origin) | uint(path.ray.direction == other.ray.direction) << 1 |
           uint(path.ray.skipPrimitive == other.ray.skipPrimitive) << 2 |
           uint(path.ray.skipPlacement == other.ray.skipPlacement) << 3 |
           uint(path.ray.passed == other.ray.passed) << 4 |
           uint(path.ray.passedPlacement == other.ray.passedPlacement) << 5 |
           uint(path.ray.tMin == other.ray.tMin) << 6 | uint(path.ray.tMax == other.ray.tMax) << 7;
}

/// writer, reader: bits of who stores the path and who goes on with it.
uint partsKept(uint writer, uint reader) {
    PathState path, found;
    Job job;
    const PathSlot slot = slotOf(1u);
    loadPath(slot, path, job, ALWAYS);
    setRay(path, vec3(1.0, 2.0, 3.0), vec3(4.0, 5.0, 6.0), 7u, 11.0);
    found = path;
    setRay(found, vec3(0.0), vec3(0.0), 0u, 0.0);
    storePath(slot, path, job, writer);
    loadPath(slot, found, job, reader);
    return partsOf(path, found);
}

void main() {
    if (gl_GlobalInvocationID.x != 0u) return;
    const uint dispatches = partsKept(KEPT, KEPT), bounces = partsKept(BY_DEPART, BY_TRACE);
    const uint lightSamples = partsKept(BY_LIGHT, BY_TRACE);
    pathWords[0] = dispatches;
    pathWords[1] = bounces;
    pathWords[2] = lightSamples;
}
