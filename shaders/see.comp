#version 460
// What the camera sees, without light: alpha and the layers of a picture (docs/layers.md). Each lane
// has one pixel, and takes the camera rays that the path kernel takes for the same numbers of samples.
// Same traversal code and the same shape of loop as there: a number of steps, then a service pass.
#extension GL_GOOGLE_include_directive : require

#include "shared/interface.h"
#include "shared/scene_types.h"
#include "shared/render_types.h"
#include "shared/texture_types.h"
#include "shared/layer_types.h"

#include "include/specialisation.glsl"
layout(constant_id = SPEC_SEES_SURFACES) const bool SEES_SURFACES = true;

#include "include/fetch.glsl"

layout(set = 0, binding = BINDING_FRAME, std140) uniform FrameBuffer { Frame frameBuffer; };
layout(set = 0, binding = BINDING_SEEN_PIXELS, std430) buffer SeenBuffer { SeenPixel seenPixels[]; };
layout(set = 0, binding = BINDING_SEEN_STATUS, std430) buffer StatusBuffer { SeeStatus status; };
layout(push_constant) uniform DispatchConstants { SeeDispatch dispatch; };

Frame frame; // read once, before all loops (docs/kernel.md, "Nothing is moved out of loops")

#include "include/numerics.glsl"
#include "include/random.glsl"
#include "include/intersect.glsl"
#include "include/traverse.glsl"
#include "include/camera.glsl"
#include "include/warps.glsl"
#include "include/pixel_filter.glsl"
#include "include/cs184.glsl"
#include "include/surface.glsl"
#include "closures/bsdf.glsl"
#include "include/material_detail.glsl"
#include "include/relief.glsl"
#include "include/pass_number.glsl"
#include "include/camera_sample.glsl"
#include "closures/seen_surface.glsl"

SeenPixel seen;
Traversal ray;
float rayEnd; ///< tMax as the ray began; its own shrinks to its hits
bool isUnderWay; ///< a camera ray, or what follows from it
uint bounce;     ///< mirrors and glass that it has met
vec3 throughput; ///< the colour that these give to what is seen in them
float filterWeight; ///< of the sample under way
vec3 firstNormal; ///< of the surface that the camera sees
uint rayCount;

void setRay(vec3 origin, vec3 direction, float tMin, float tMax, uint skipPrimitive) {
    ray.origin = origin;
    ray.direction = direction;
    ray.tMin = tMin;
    ray.tMax = tMax;
    ray.skipPrimitive = skipPrimitive;
    ray.passed = NO_PRIMITIVE;
    ray.skipPlacement = NO_PLACEMENT;
    rayEnd = tMax;
}

/// Of the sample under way: block 0 as in the path kernel, and one for each mirror.
uint sampleIndex() { return frame.firstSample + seen.samples; }
uvec4 randomWords() { return randomWords(seen.pixel, sampleIndex(), bounce, frame.seed); }

void beginSample() {
    bounce = 0u;
    throughput = vec3(1.0);
    isUnderWay = true;
    const uvec2 at = uvec2(seen.pixel % frame.width, seen.pixel / frame.width);
    const CameraRay c = cameraRayOfSample(at, seen.pixel, sampleIndex(), unitFloats(randomWords()).zw, filterWeight);
    setRay(c.origin, c.direction, c.tMin, c.tMax, NO_PRIMITIVE);
}

void endSample(vec3 albedo, vec3 normal) {
    seen.albedo += clamp(albedo, 0.0, 1.0);
    seen.normal += normal;
    ++seen.samples;
    isUnderWay = false;
}

void noteFirst(SurfacePoint s) {
    firstNormal = shadingNormal(s);
    seen.position += s.position;
    if (seen.hits == 1u) {
        seen.primitive = primitiveAt(ray.hitPrimitive);
        seen.b1 = ray.b1;
        seen.b2 = ray.b2;
        seen.placement = NO_SEEN_PLACEMENT;
        if (HAS_PLACEMENTS && s.placement != NO_PLACEMENT)
            seen.placement = fetchPlacement(s.placement).placement & ~PLACEMENT_MIRRORS;
    }
}

/// At a mirror or glass: goes on to what is seen there, unless it lets nothing through.
void follow(Material m, SurfacePoint s) {
    const vec4 u = unitFloats(randomWords());
    const BsdfSample b = sampleBsdf(m, s, u.zwx);
    throughput *= tintOf(m, b);
    if (largestComponent(throughput) > 0.0) {
        const bool transmitted = isTransmission(b.lobe);
        setRay(leave(s, b.direction, transmitted), b.direction, 0.0, INFINITE_DISTANCE,
               skipOnLeaving(s, transmitted));
        ray.skipPlacement = s.placement;
    } else {
        endSample(vec3(0.0), firstNormal);
    }
}

void arrive() {
    SurfacePoint s = surfaceAt(ray);
    if (HAS_BLENDS) s.material = materialOfSide(s);
    const MaterialAtPoint at = lookUpMaterial(materialPoint(s));
    const Material m = at.parameters;
    faceForward(s);
    applyRelief(s, at.relief, dependsOnView(m), reliefRules(m));
    if (bounce == 0u) noteFirst(s);
    const bool isFollowed = isSeenThrough(m);
    ++bounce;
    if (!isFollowed) endSample(throughput * albedoOf(m), shadingNormal(s));
    else if (bounce > MOST_SEEN_THROUGH) endSample(throughput, firstNormal);
    else follow(m, s);
}

/// Takes in the finished ray.
void takeResult() {
    const bool hit = ray.hitPrimitive != NO_PRIMITIVE;
    bool passes = false;
    if (HAS_ALPHA && hit) {
        const MaterialPoint point = materialPoint(ray.hitPrimitive, vec2(ray.b1, ray.b2));
        const float opacity = lookUpMaterial(point).opacity;
        passes = passNumber(ray, seen.pixel, sampleIndex(), bounce, 0u) >=
                 (bounce == 0u ? opacityForCamera(point, opacity) : opacity);
    }
    if (passes) {
        passOn(ray, rayEnd);
        return;
    }
    if (hit && bounce == 0u) {
        ++seen.hits;
        seen.covered += filterWeight;
    }
    if (SEES_SURFACES && hit) arrive();
    else if (bounce > 0u) endSample(throughput, firstNormal); // a mirror that shows the sky
    else endSample(vec3(0.0), vec3(0.0));
}

bool isAtWork(uint iteration) {
    return isUnderWay || seen.samples < seen.target && iteration < dispatch.softIterations;
}

void main() {
    frame = frameBuffer;
    findPictureGrid();
    const uint lane = gl_GlobalInvocationID.x;
    if (lane >= dispatch.pixelCount) return;
    seen = seenPixels[lane];
    isUnderWay = false;
    rayCount = 0u;
    startTraversal(ray, vec3(0.0), vec3(0.0), 0.0, 0.0, NO_PRIMITIVE, false); // done at once

    // Every exit is in a loop's header (docs/kernel.md, "Exits of loops").
    uint iteration = 0u;
    while (isAtWork(iteration) && iteration < dispatch.hardIterations) {
        if (!isUnderWay) beginSample();
        if (!traversing(ray)) {
            startTraversal(ray);
            ++rayCount;
        }
        const Ray prepared = makeRay(ray.origin, ray.direction);
        for (uint leg = 0u; leg < TRAVERSAL_LEGS; ++leg) {
            const Ray aimed = prepareLeg(ray, prepared);
            for (uint k = 0u; k < TRAVERSAL_STEPS; ++k)
                traversalStep(ray, aimed);
        }
        if (!traversing(ray)) takeResult();
        ++iteration;
    }
    seenPixels[lane] = seen;
    if (isUnderWay) atomicAdd(status.overflowedPixels, 1u);
    else if (seen.samples < seen.target) atomicAdd(status.unfinishedPixels, 1u);
    atomicAdd(status.rays, rayCount);
}
