#version 460
#extension GL_GOOGLE_include_directive : require
// The path tracer as the textbook has it: for each sample, for each bounce, trace a ray to its end,
// then each shadow ray to its own, then scatter. One pixel an invocation, and nothing of the
// product kernel's scheduling: what pathtrace.comp does with the same functions must be the same.
#include "shared/interface.h"
#include "shared/scene_types.h"
#include "shared/render_types.h"
#include "shared/texture_types.h"
#include "shared/guide_types.h"

#include "include/specialisation.glsl"
#include "include/fetch.glsl"
#include "include/film.glsl"

layout(set = 0, binding = BINDING_FRAME, std140) uniform FrameBuffer { Frame frame; };
layout(set = 0, binding = BINDING_STATUS, std430) buffer StatusBuffer { DispatchStatus status; };
layout(push_constant) uniform DispatchConstants { Dispatch dispatch; };

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

/// Also looks up the material where the ray asks for one. A ray that passes a surface which is partly there is traced on.
void traceToTheEnd(const Given given, inout PathState path, inout uint loopPasses) {
    bool goesOn = true;
    Stack stack;
    while (goesOn) {
        startRay(path, stack);
        const Ray prepared = makeRay(path.ray.origin, path.ray.direction);
        while (traversing(path.ray)) {
            traversalStep(path.ray, stack, prepared);
            testWaitingSphere(path.ray, prepared);
            ++loopPasses;
        }
        const bool isUnderWay = goThroughMedium(given, path);
        const MaterialPoint asked = askedPoint(path);
        path.found = lookUpMaterial(asked);
        goesOn = isUnderWay || HAS_ALPHA && passesThrough(given.frame, path, asked, path.found.opacity);
        ++loopPasses;
    }
}

void gatherDirectLight(const Given given, inout PathState path, inout uint loopPasses) {
    const uint samples = directSamples(given.frame);
    while (path.directIndex < samples) {
        sampleDirect(given, path);
        const bool isShadowRay = path.phase == PHASE_SHADOW;
        if (isShadowRay || path.phase == PHASE_HEMISPHERE) {
            traceToTheEnd(given, path, loopPasses);
            if (isShadowRay) finishShadowRay(path, foundSky(given, path));
            else finishHemisphereRay(given, path);
        }
        ++loopPasses;
    }
}

void decideToGoOn(const Given given, inout PathState path) {
    path.phase = endsHere(given.frame, path) ? PHASE_ENDED : PHASE_BOUNCE;
}

/// From a place to the next: where the ray goes, all of it, what is there, and all of the light there.
void followRay(const Given given, inout PathState path, inout uint loopPasses) {
    depart(given, path);
    if (path.phase == PHASE_PATH) {
        traceToTheEnd(given, path, loopPasses);
        arrive(given, path, foundSky(given, path));
        if (INTEGRATOR == INTEGRATOR_PATH && path.phase == PHASE_DIRECT) {
            gatherDirectLight(given, path, loopPasses);
            decideToGoOn(given, path);
        }
    }
}

/// Bounce after bounce, then each branch in turn. Functions are inlined wherever they are called, and drivers take long
/// over large modules: so a loop over all rays of a sample, with one call of what follows a ray.
void takeSample(const Given given, inout PathState path, inout uint loopPasses) {
    path.phase = PHASE_NEXT;
    bool goesOn = true;
    while (goesOn) {
        if (path.phase != PHASE_ENDED) followRay(given, path, loopPasses);
        if (branchIsOver(path)) {
            nextBranch(path, materialAt(path.splitPoint.surface));
            decideToGoOn(given, path);
        }
        goesOn = path.phase == PHASE_BOUNCE || branchIsOver(path);
        ++loopPasses;
    }
    finishSample(given.frame, path);
}

/// segmentBase: the samples that each pixel gets.
void main() {
    PathState path;
    const uint pixel = gl_GlobalInvocationID.x;
    if (pixel >= dispatch.itemCount) return;
    path.pixelState = fetchPixel(pixel);
    path.pixelAt = uvec2(pixel % frame.width, pixel / frame.width);
    path.pixelId = pixel;
    Given given;
    given.frame = frame;
    given.grid = pictureGrid(frame);
    given.onlyLight = findOnlyLight();
    given.roots = findRoots(frame);
    given.gap = findGap(frame, given.onlyLight);
    for (uint i = 0u; i < PORTALS; ++i)
        given.portals.all[i] = portalOf(frame, i);
    if (HAS_AMBIENT) given.sky = fetchLightRows(0u);
    endTraversal(path.ray);
    path.rayCount = 0u;
    uint loopPasses = 0u; // llvmpipe ends all loops of a group at 65,535
    for (uint i = 0u; i < dispatch.segmentBase; ++i)
        takeSample(given, path, loopPasses);
    storePixel(pixel, path.pixelState);
    atomicAdd(status.rays, path.rayCount);
    atomicMax(status.allSteps, loopPasses);
}
