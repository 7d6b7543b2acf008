#version 460
#extension GL_GOOGLE_include_directive : require
// The path tracer as the textbook has it: for each sample, for each bounce, trace a ray to its end,
// then each shadow ray to its own, then scatter. One pixel an invocation, and nothing of the
// product kernel's scheduling: what pathtrace.comp does with the same functions must be the same.
#include "shared/interface.h"
#include "shared/scene_types.h"
#include "shared/render_types.h"
#include "shared/texture_types.h"

#include "include/specialisation.glsl"
#include "include/fetch.glsl"
#include "include/film.glsl"

layout(set = 0, binding = BINDING_FRAME, std140) uniform FrameBuffer { Frame frame; };
layout(set = 0, binding = BINDING_STATUS, std430) buffer StatusBuffer { DispatchStatus status; };
layout(push_constant) uniform DispatchConstants { Dispatch dispatch; };

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

uint loopPasses; ///< of this invocation: llvmpipe ends all loops of a group at 65,535

/// Also looks up the material where the ray asks for one. A ray that passes a surface which is partly there is traced on.
void traceToTheEnd() {
    bool goesOn = true;
    while (goesOn) {
        startRay();
        const Ray prepared = makeRay(ray.origin, ray.direction);
        while (traversing(ray)) {
            traversalStep(ray, prepared);
            ++loopPasses;
        }
        const MaterialPoint asked = askedPoint();
        found = lookUpMaterial(asked);
        goesOn = HAS_ALPHA && passesThrough(asked, found.opacity);
        ++loopPasses;
    }
}

void gatherDirectLight() {
    const uint samples = directSamples();
    while (directIndex < samples) {
        sampleDirect();
        if (phase == PHASE_SHADOW) {
            traceToTheEnd();
            finishShadowRay();
        }
        if (phase == PHASE_HEMISPHERE) {
            traceToTheEnd();
            finishHemisphereRay();
        }
        ++loopPasses;
    }
}

void bounceOn() {
    phase = endsHere() ? PHASE_ENDED : PHASE_BOUNCE;
    if (phase == PHASE_BOUNCE) depart();
}

void followToTheEnd() {
    while (phase == PHASE_PATH) {
        traceToTheEnd();
        arrive();
        if (INTEGRATOR == INTEGRATOR_PATH && phase == PHASE_DIRECT) {
            gatherDirectLight();
            bounceOn();
        }
        ++loopPasses;
    }
}

void takeSample() {
    phase = PHASE_NEXT;
    depart();
    followToTheEnd();
    while (branchIsOver()) {
        nextBranch();
        bounceOn();
        followToTheEnd();
        ++loopPasses;
    }
    finishSample();
}

/// segmentBase: the samples that each pixel gets.
void main() {
    const uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= dispatch.itemCount) return;
    pixelState = fetchPixel(pixel);
    pixelAt = uvec2(pixel % frame.width, pixel / frame.width);
    pixelId = pixel;
    findPictureGrid();
    findOnlyLight();
    if (GAP_PROPOSAL) findGap();
    endTraversal(ray);
    rayCount = 0u;
    waits = false;
    loopPasses = 0u;
    for (uint i = 0u; i < dispatch.segmentBase; ++i)
        takeSample();
    storePixel(pixel, pixelState);
    atomicAdd(status.rays, rayCount);
    atomicMax(status.allSteps, loopPasses);
}
