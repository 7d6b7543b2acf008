// What a dispatch is told and what it leaves behind.
#ifndef STROMBOLI_SHARED_RENDER_TYPES_H
#define STROMBOLI_SHARED_RENDER_TYPES_H

#include "language.h"

SHARED_BEGIN

/// Rectangles that stop light samples, at most, and rows of each (include/occluders.glsl).
SHARED_CONST uint MOST_OCCLUDERS = 8u;
SHARED_CONST uint OCCLUDER_ROWS = 3u;

/// Portals of a room, at most, and rows of each (lights/portals.glsl).
SHARED_CONST uint MOST_PORTALS = 8u;
SHARED_CONST uint PORTAL_ROWS = 5u;

/// Cells along a side of a shadow map (include/shadow_map.glsl), four to a row of the buffer of guided samples.
SHARED_CONST uint SHADOW_MAP_SIDE = 512u;

/// What all dispatches of a picture have in common.
struct Frame {
    vec3 cameraPosition;
    uint width;       ///< of the whole picture, pixels
    vec3 cameraRight; ///< times halfWidth
    uint height;
    vec3 cameraUp; ///< times halfHeight
    uint firstSample; ///< number of the first sample of each pixel: 0, that of a block, or of a sample on its own
    vec3 cameraBack; ///< of perspective cameras: from the middle of the picture
    uint keepsValue; ///< 1: leave the last sample's value in PixelState::sum, rejected or not
    float nearDistance;
    float farDistance;
    float gapWidth; ///< host/kernel/gpu_scene.hpp
    uint seed;
    uint minBounce;
    uint maxBounces;
    float terminationProbability; ///< roulette, fixed
    uint lightCount; ///< LightEntry rows: of all lights that light samples go to, and of none where they may take none
    uint areaLights; ///< those of them that rays can meet, which come first (LIGHT_CHOICE_EACH)
    uint hemisphereSamples; ///< directions per shading point that are tried to find lights
    uint lightSamples; ///< samples of lights per shading point, of all together
    uint branches; ///< of a sample's path, from the first surface that scatters at random
    uint ambientLight; ///< the number of the ambient light; NO_LIGHT: it is not sampled
    uint lightsInGroup0, lightsInGroup1, lightsInGroup2; ///< by LIGHT_GROUP_: how many the light tree has
    float lensRadius;
    float focusDistance; ///< of the plane that is sharp, along the view axis
    uint cameraMedium; ///< where camera rays begin: the first row of a medium, or NO_MEDIUM
    float portalShare; ///< of light samples to the sky that aim at portals (lights/portals.glsl)
    uint litCells; ///< that bounces aim at, with AIMS_BOUNCES (aimed_bounces.glsl)
    float leastFall; ///< of a ray that crosses an occluder: its square over that of the ray's length
    uint unused0, unused1;
    vec4 shadowAcross, shadowAlong; ///< of the shadow map's cells: column and row of a point p are dot(xyz, p) + w
    vec3 shadowTowards; ///< to its light, unit; 0: there is no map
    uint shadowMap; ///< its first row in the buffer of guided samples
    vec4 portals[PORTAL_ROWS * MOST_PORTALS];
    vec4 occluders[OCCLUDER_ROWS * MOST_OCCLUDERS];
};
SHARED_ROWS(Frame, 77);
SHARED_OFFSET(Frame, nearDistance, 64);
SHARED_OFFSET(Frame, areaLights, 96);

/// Push constants of one dispatch.
struct Dispatch {
    uint itemCount;
    uint segmentBase;    ///< first pixel of the crop that the bound film segment holds
    uint softIterations; ///< start no further ray of a path at or after this loop iteration
    uint hardIterations; ///< leave the loop here: an error, reported as overflow
    uint laneCount;      ///< invocations that take part
    uint groupsPerThread;  ///< that a thread of the driver runs in turn; 0: not known
    uint sharedIterations; ///< of all lanes together until each thread shall have ended one group
    uint beginsNoSample;   ///< 1: the render was stopped; only what is under way may be ended
    uint rayQueue; ///< wavefront scheduler: QUEUE_ number of the rays of this round
    uint framePlace; ///< 0: of the frame in its buffer (docs/theory/kernel.md, "Constants")
    uint unused0, unused1;
};
SHARED_ROWS(Dispatch, 3);

/// One pixel's work in a pass, or that of one of its strands.
struct WorkItem {
    uint pixel;  ///< index of its state in the film segment
    uint target; ///< number of samples the state shall have
    uint column; ///< in the whole picture
    uint row;    ///< from the top
};
SHARED_ROWS(WorkItem, 1);

/// Statistics of a pixel's samples, updated one sample at a time, so that they do not depend on
/// how samples are cut into dispatches. Sums are two floats (value + error) to stay right at
/// 1e7 samples and more.
///
/// Where a picture has fewer pixels than a device has lanes, a pixel has several states one after
/// the other, its strands: sample i is dealt to strand i mod STRANDS, which a lane of its own may
/// take up. The host adds strands in their order, so that no sum depends on who was first.
struct PixelState {
    vec3 sum;
    uint count; ///< samples in the sums
    vec3 sumError;
    uint rejected;      ///< samples that were not finite, or negative
    vec3 m2;            ///< sum of squared deviations from the running mean (Welford 1962)
    uint firstRejected; ///< sample index; means nothing while none is
    vec3 m2Error;
    uint samplesBefore; ///< that the pixel had when the pass under way took it up, of all blocks and strands
};
SHARED_CONST uint PIXEL_STATE_ROWS = 4u;
SHARED_ROWS(PixelState, PIXEL_STATE_ROWS);
SHARED_OFFSET(PixelState, rejected, 28);

SHARED_CONST uint NO_ITEM = 0xFFFFFFFFu;

/// Counters of one dispatch; zeroed by the host before it, but for nextItem.
struct DispatchStatus {
    uint unfinishedItems; ///< items that lanes have in hand
    uint overflowedItems; ///< items whose loop hit its limit: their samples are wrong
    uint rays;
    uint samples;
    uint nextItem;  ///< the first item that no lane has taken
    uint busySteps; ///< traversal steps of lanes that had a ray under way (COUNT_STEPS) ...
    uint allSteps;  ///< ... out of these
    uint iterations; ///< loop iterations of all lanes, where groupsPerThread is not 0
};
SHARED_ROWS(DispatchStatus, 2);

SHARED_END

#endif
