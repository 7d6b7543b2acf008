#version 460
// What the camera sees, without light: alpha and the layers of a picture (docs/guide/layers.md). Each lane
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

#include "include/given.glsl"
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
#include "include/mixture.glsl"
#include "include/camera_sample.glsl"
#include "closures/seen_surface.glsl"

/// What a lane knows of its pixel and of the camera ray under way.
struct Look {
    SeenPixel seen;
    Traversal ray;
    float rayEnd;       ///< tMax as the ray began; its own shrinks to its hits
    bool isUnderWay;    ///< a camera ray, or what follows from it
    uint bounce;        ///< mirrors and glass that it has met
    vec3 throughput;    ///< the colour that these give to what is seen in them
    float filterWeight; ///< of the sample under way
    vec3 firstNormal;   ///< of the surface that the camera sees
    uint rayCount;
};

void setRay(inout Look look, vec3 origin, vec3 direction, float tMin, float tMax, uint skipPrimitive) {
    look.ray.origin = origin;
    look.ray.direction = direction;
    look.ray.tMin = tMin;
    look.ray.tMax = tMax;
    look.ray.skipPrimitive = skipPrimitive;
    look.ray.passed = NO_PRIMITIVE;
    look.ray.skipPlacement = NO_PLACEMENT;
    look.rayEnd = tMax;
}

/// The number of the sample under way, whose random words are block 0 as in the path kernel, and a block for each mirror.
uint sampleIndex(const Frame frame, Look look) { return frame.firstSample + look.seen.samples; }
uvec4 randomWords(const Frame frame, Look look) {
    return randomWords(look.seen.pixel, sampleIndex(frame, look), look.bounce, frame.seed);
}

void beginSample(const Given given, inout Look look) {
    const Frame frame = given.frame;
    look.bounce = 0u;
    look.throughput = vec3(1.0);
    look.isUnderWay = true;
    const uvec2 at = uvec2(look.seen.pixel % frame.width, look.seen.pixel / frame.width);
    const CameraRay c = cameraRayOfSample(given, at, look.seen.pixel, sampleIndex(frame, look),
                                           unitFloats(randomWords(frame, look)).zw, look.filterWeight);
    setRay(look, c.origin, c.direction, c.tMin, c.tMax, NO_PRIMITIVE);
}

void endSample(inout Look look, vec3 albedo, vec3 normal) {
#define ADD_SUM(name, value) look.seen.name.xyz += value;
    SUMS_OF_END(ADD_SUM)
    ++look.seen.samples;
    look.isUnderWay = false;
}

void noteFirst(inout Look look, Material m, SurfacePoint s) {
    look.firstNormal = shadingNormal(s);
    SUMS_OF_FIRST(ADD_SUM)
    if (look.seen.hits == 1u) {
        look.seen.primitive = primitiveAt(look.ray.hitPrimitive);
        look.seen.b1 = look.ray.b1;
        look.seen.b2 = look.ray.b2;
        look.seen.placement = NO_SEEN_PLACEMENT;
        if (HAS_PLACEMENTS && s.placement != NO_PLACEMENT)
            look.seen.placement = fetchPlacement(s.placement).placement & ~PLACEMENT_MIRRORS;
    }
}

/// Goes on with the camera ray that the last dispatch has left.
void resume(inout Look look) {
    look.isUnderWay = look.seen.isUnderWay != 0u;
    look.bounce = look.seen.bounce;
    look.throughput = look.seen.throughput;
    look.filterWeight = look.seen.filterWeight;
    look.firstNormal = look.seen.firstNormal;
    setRay(look, look.seen.origin, look.seen.direction, look.seen.tMin, look.seen.tMax, look.seen.skipPrimitive);
    look.ray.passed = look.seen.passed;
    look.ray.passedPlacement = look.seen.passedPlacement;
    look.ray.skipPlacement = look.seen.skipPlacement;
}

/// Keeps the camera ray for the next dispatch, which begins at the surface that it has passed last. Returns whether it
/// has come farther in this one.
bool pause(inout Look look) {
    const bool hasMoved = look.seen.isUnderWay == 0u || look.bounce != look.seen.bounce ||
                          look.ray.tMin != look.seen.tMin || look.ray.passed != look.seen.passed;
    look.seen.isUnderWay = 1u;
    look.seen.bounce = look.bounce;
    look.seen.throughput = look.throughput;
    look.seen.filterWeight = look.filterWeight;
    look.seen.firstNormal = look.firstNormal;
    look.seen.origin = look.ray.origin;
    look.seen.direction = look.ray.direction;
    look.seen.tMin = look.ray.tMin;
    look.seen.tMax = look.rayEnd;
    look.seen.skipPrimitive = look.ray.skipPrimitive;
    look.seen.passed = look.ray.passed;
    look.seen.passedPlacement = look.ray.passedPlacement;
    look.seen.skipPlacement = look.ray.skipPlacement;
    return hasMoved;
}

/// At a mirror or glass: goes on to what is seen there, unless it lets nothing through.
void follow(const Frame frame, inout Look look, Material m, SurfacePoint s) {
    const vec4 u = unitFloats(randomWords(frame, look));
    const BsdfSample b = sampleBsdf(m, s, u.zwx);
    look.throughput *= tintOf(m, b);
    if (largestComponent(look.throughput) > 0.0) {
        const bool transmitted = isTransmission(b.lobe);
        setRay(look, leave(s, b.direction, transmitted), b.direction, 0.0, INFINITE_DISTANCE,
               skipOnLeaving(s, transmitted));
        look.ray.skipPlacement = s.placement;
    } else {
        endSample(look, vec3(0.0), look.firstNormal);
    }
}

void arrive(const Frame frame, inout Look look) {
    SurfacePoint s = surfaceAt(look.ray);
    if (HAS_BLENDS) s.material = materialOfSide(s);
    const MaterialAtPoint at = lookUpMaterial(materialPoint(s));
    const Material m = at.parameters;
    faceForward(s);
    applyRelief(s, at.relief, dependsOnView(m), reliefRules(m));
    if (look.bounce == 0u) noteFirst(look, m, s);
    const bool isFollowed = isSeenThrough(m);
    ++look.bounce;
    if (!isFollowed) endSample(look, look.throughput * albedoOf(m), shadingNormal(s));
    else if (look.bounce > MOST_SEEN_THROUGH) endSample(look, look.throughput, look.firstNormal);
    else follow(frame, look, m, s);
}

/// Takes in the finished ray.
void takeResult(const Frame frame, inout Look look) {
    const bool hit = look.ray.hitPrimitive != NO_PRIMITIVE;
    bool passes = false;
    if (HAS_ALPHA && hit) {
        const MaterialPoint point = materialPoint(look.ray.hitPrimitive, vec2(look.ray.b1, look.ray.b2));
        const float opacity = lookUpMaterial(point).opacity;
        const uvec4 words = hitWords(frame.seed, look.ray, look.seen.pixel, sampleIndex(frame, look), look.bounce);
        passes = hitNumber(words, 0u) >=
                 (look.bounce == 0u ? opacityForCamera(point, opacity) : opacity);
    }
    if (passes) {
        passOn(look.ray, look.rayEnd);
        return;
    }
    if (hit && look.bounce == 0u) {
        ++look.seen.hits;
        look.seen.covered += look.filterWeight;
    }
    if (SEES_SURFACES && hit) arrive(frame, look);
    else if (look.bounce > 0u) endSample(look, look.throughput, look.firstNormal); // a mirror that shows the sky
    else endSample(look, vec3(0.0), vec3(0.0));
}

bool isAtWork(Look look, uint softIterations, uint iteration) {
    return look.isUnderWay || look.seen.samples < look.seen.target && iteration < softIterations;
}

void main() {
    Given given;
    given.frame = frameBuffer;
    given.grid = pictureGrid(given.frame);
    const uint softIterations = dispatch.softIterations, hardIterations = dispatch.hardIterations;
    const uint lane = gl_GlobalInvocationID.x;
    if (lane >= dispatch.pixelCount) return;
    Look look;
    Stack stack;
    look.seen = seenPixels[lane];
    look.rayCount = 0u;
    startTraversal(look.ray, stack, vec3(0.0), vec3(0.0), 0.0, 0.0, NO_PRIMITIVE, false); // done at once
    resume(look);

    // Every exit is in a loop's header (docs/theory/kernel.md, "Exits of loops").
    uint iteration = 0u;
    while (isAtWork(look, softIterations, iteration) && iteration < hardIterations) {
        if (!look.isUnderWay) beginSample(given, look);
        if (!traversing(look.ray)) {
            startTraversal(look.ray, stack);
            ++look.rayCount;
        }
        const Ray prepared = makeRay(look.ray.origin, look.ray.direction);
        for (uint leg = 0u; leg < TRAVERSAL_LEGS; ++leg) {
            const Ray aimed = prepareLeg(look.ray, prepared);
            for (uint k = 0u; k < TRAVERSAL_STEPS; ++k)
                traversalStep(look.ray, stack, aimed);
        }
        if (!traversing(look.ray)) takeResult(given.frame, look);
        ++iteration;
    }
    bool hasMoved = true;
    if (look.isUnderWay) hasMoved = pause(look);
    else look.seen.isUnderWay = 0u;
    seenPixels[lane] = look.seen;
    if (!hasMoved) atomicAdd(status.overflowedPixels, 1u);
    else if (look.isUnderWay || look.seen.samples < look.seen.target) atomicAdd(status.unfinishedPixels, 1u);
    atomicAdd(status.rays, look.rayCount);
}
