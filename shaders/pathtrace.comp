#version 460
// The path kernel: one invocation takes the samples of one pixel that a dispatch asks for.
#extension GL_GOOGLE_include_directive : require

#include "shared/interface.h"
#include "shared/scene_types.h"
#include "shared/render_types.h"

#include "include/specialisation.glsl"
#include "include/fetch.glsl"

layout(set = 0, binding = BINDING_FRAME, std140) uniform FrameBuffer { Frame frame; };
layout(set = 0, binding = BINDING_WORK_ITEMS, std430) readonly buffer WorkBuffer {
    WorkItem workItems[];
};
layout(set = 0, binding = BINDING_PIXELS, std430) buffer PixelBuffer { PixelState pixels[]; };
layout(set = 0, binding = BINDING_SUSPENDED, std430) buffer SuspendedBuffer {
    SuspendedPath suspendedPaths[];
};
layout(set = 0, binding = BINDING_STATUS, std430) buffer StatusBuffer { DispatchStatus status; };
layout(push_constant) uniform DispatchConstants { Dispatch dispatch; };

#include "include/numerics.glsl"
#include "include/random.glsl"
#include "include/intersect.glsl"
#include "include/traverse.glsl"
#include "include/camera.glsl"
#include "include/surface.glsl"
#include "include/bsdf.glsl"
#include "include/lights.glsl"
#include "include/accumulate.glsl"
#include "include/path.glsl"

/// A lane about to trace a path ray may put it off to the next dispatch; in any other phase too
/// much would have to be remembered.
bool suspendable() { return phase == PHASE_PATH; }

void resume(uint item) {
    const SuspendedPath p = suspendedPaths[item];
    phase = PHASE_NEXT;
    ray.current = CHILD_NONE;
    ray.hitPrimitive = NO_PRIMITIVE;
    ray.stackTop = 0u;
    if (p.bounce == SUSPENDED_NONE) return;
    sampleIndex = pixelState.count + pixelState.rejected;
    bounce = p.bounce;
    throughput = p.throughput;
    radiance = p.radiance;
    countsEmission = p.countsEmission != 0u;
    trace(PHASE_PATH, p.origin, p.direction, 0.0, INFINITE_DISTANCE, p.skipPrimitive);
}

/// Remembers a bounce ray that has just been started; a camera ray is simply begun anew.
void suspend(uint item) {
    SuspendedPath p;
    p.origin = ray.ray.origin;
    p.bounce = bounce == 0u ? SUSPENDED_NONE : bounce;
    p.direction = ray.ray.direction;
    p.skipPrimitive = ray.skipPrimitive;
    p.throughput = throughput;
    p.countsEmission = countsEmission ? 1u : 0u;
    p.radiance = radiance;
    p.unused = 0u;
    suspendedPaths[item] = p;
    --rayCount;
}

void main() {
    const uint item = gl_GlobalInvocationID.x;
    if (item >= dispatch.itemCount) return;
    const WorkItem work = workItems[item];
    pixelState = pixels[work.pixel];
    const uint cropPixel = dispatch.segmentBase + work.pixel;
    pixelAt = uvec2(frame.cropX + cropPixel % frame.cropWidth,
                    frame.cropY + cropPixel / frame.cropWidth);
    pixelId = pixelAt.y * frame.width + pixelAt.x;
    const uint samplesBefore = pixelState.count + pixelState.rejected;
    rayCount = 0u;
    resume(item);

    // Every exit is in the loop's header: an exit in the middle of such a loop was seen to be
    // miscompiled by llvmpipe. The limit keeps a dispatch finite on any device, and below the
    // number of loop iterations after which llvmpipe ends all loops without a word.
    bool suspended = false;
    uint iteration = 0u;
    while (phase != PHASE_FINISHED && !suspended && iteration < dispatch.hardIterations) {
        for (uint k = 0u; k < TRAVERSAL_STEPS; ++k)
            if (traversing(ray)) traversalStep(ray);
        // `if` does not branch on llvmpipe, a loop does: groups without a waiting lane skip this.
        bool waiting = !traversing(ray);
        while (waiting) {
            serve(work.target);
            suspended = suspendable() && iteration >= dispatch.softIterations;
            waiting = false;
        }
        ++iteration;
    }
    const bool overflowed = phase != PHASE_FINISHED && !suspended;
    suspendedPaths[item].bounce = SUSPENDED_NONE;
    if (suspended) suspend(item);

    pixels[work.pixel] = pixelState;
    if (suspended) atomicAdd(status.unfinishedItems, 1u);
    if (overflowed) atomicAdd(status.overflowedItems, 1u);
    atomicAdd(status.rays, rayCount);
    atomicAdd(status.samples, pixelState.count + pixelState.rejected - samplesBefore);
}
