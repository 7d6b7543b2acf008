// Layers: what pictures say of a pixel beside its radiance, and the sums over camera rays that they are made of, which
// shaders/see.comp takes. Names, help and channels of layers, the structures of sums and their way from the device to
// the host follow from the two tables.
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

// F(name, value): a sum of vectors over the camera rays of a pixel (docs/guide/layers.md).
//   value  GLSL: what a ray adds

/// What a ray adds that meets something: of the surface `s` that it meets first, and its Material `m`.
#define SUMS_OF_FIRST(F) \
    F(position, s.position)
/// What each adds in the end: of what is seen, also in mirrors and through glass. albedo and normal: of that; zero where
/// nothing is.
#define SUMS_OF_END(F) \
    F(albedo, clamp(albedo, 0.0, 1.0)) \
    F(normal, normal)
#define SEEN_SUMS(F) SUMS_OF_FIRST(F) SUMS_OF_END(F)

// F(name, text, help, channels, value): the layers.
//   text, help  of --layers
//   channels    the last letters of its channels' names
//   value       C++: of a SeenPixel `s` of the host, the `scene` and the `camera` (host/render/layers.cpp)
#define LAYER_LIST(F) \
    F(Albedo, "albedo", "color in white light", "RGB", meanOf(s.albedo, s.samples)) \
    F(Normal, "normal", "shading normal", "XYZ", meanOf(s.normal, s.samples)) \
    F(Depth, "depth", "metres along the camera's axis", "Z", depthOf(s, camera)) \
    F(Position, "position", "in the world, metres", "XYZ", positionOf(s, scene)) \
    F(Uv, "uv", "first texture coordinates", "UV", uvOf(s, scene)) \
    F(Object, "object", "number of the mesh or sphere", "X", objectOf(s, scene)) \
    F(Material, "material", "number of the material", "X", materialOf(s, scene))

/// One pixel: sums over its camera rays so far, what it is asked for, and the ray under way.
struct SeenPixel {
#define DECLARE_SUM(name, value) vec4 name;
    SEEN_SUMS(DECLARE_SUM)
#undef DECLARE_SUM
    uint samples;   ///< camera rays that are done
    uint hits;      ///< those of them that end on a surface
    uint primitive; ///< that the first hit found, in the Primitive buffer
    uint unused0;
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
    uint unused1;
};
SHARED_WHOLE_ROWS(SeenPixel);

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
