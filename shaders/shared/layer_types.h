// What shaders/see.comp finds out of what the camera sees, and what a dispatch of it is told.
#ifndef STROMBOLI_SHARED_LAYER_TYPES_H
#define STROMBOLI_SHARED_LAYER_TYPES_H

#include "interface.h"
#include "language.h"

SHARED_BEGIN

#define BINDING_SEEN_PIXELS BINDING_COUNT
#define BINDING_SEEN_STATUS (BINDING_COUNT + 1)

#define SPEC_SEES_SURFACES SPEC_COUNT // else only whether there is one

/// Mirrors and glass in a row that albedo and normal are looked for behind: enough for a glass ball
/// seen in a mirror, with a reflection inside. Where that is not the end, the first surface counts.
SHARED_CONST uint MOST_SEEN_THROUGH = 8u;

/// One pixel: what it is asked for, and sums over its camera rays so far (docs/guide/layers.md).
struct SeenPixel {
    vec3 albedo;
    uint samples; ///< camera rays that are done
    vec3 normal;
    uint hits; ///< those of them that end on a surface
    vec3 position; ///< of the hits
    uint primitive; ///< that the first hit found, in the Primitive buffer
    float b1, b2;   ///< its barycentric weights (triangles), of the second and third corner there
    uint target;    ///< samples it shall have
    uint pixel;     ///< row * width + column in the whole picture
    uint placement; ///< that the primitive is in, in Scene::placements; NO_SEEN_PLACEMENT: none
    float covered;  ///< the sum of the hits' weights by the pixel filter
    uint isUnderWay; ///< a camera ray that passes many surfaces goes on in the next dispatch, from here on:
    uint bounce;     ///< mirrors and glass that it has met
    vec3 origin;
    float tMin; ///< of the surface that it has passed last
    vec3 direction;
    float tMax;
    vec3 throughput;
    uint passed;
    vec3 firstNormal;
    uint passedPlacement;
    uint skipPrimitive, skipPlacement;
    float filterWeight;
    uint unused0;
};
SHARED_ROWS(SeenPixel, 10);
SHARED_OFFSET(SeenPixel, b1, 48);

SHARED_CONST uint NO_SEEN_PLACEMENT = 0xFFFFFFFFu;

/// Push constants of one dispatch.
struct SeeDispatch {
    uint pixelCount;
    uint softIterations; ///< begin no further camera ray at or after this loop iteration
    uint hardIterations; ///< leave the loop here
};

/// Zeroed by the host before each dispatch.
struct SeeStatus {
    uint unfinishedPixels;
    uint overflowedPixels; ///< whose ray could not get to the next surface within a dispatch
    uint rays;
};

SHARED_END

#endif
