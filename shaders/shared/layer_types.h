// Layers: what pictures say of a pixel beside its radiance, and the sums over camera rays that they are made of, which the
// path kernel takes (include/seeing.glsl). Names, help and channels of layers, the structures of sums and their way from
// the device to the host follow from the tables.
#ifndef STROMBOLI_SHARED_LAYER_TYPES_H
#define STROMBOLI_SHARED_LAYER_TYPES_H

#include "language.h"

SHARED_BEGIN

/// Mirrors and glass in a row that albedo and normal are looked for behind: enough for a glass ball
/// seen in a mirror, with a reflection inside. Where that is not the end, the first surface counts.
SHARED_CONST uint MOST_SEEN_THROUGH = 8u;

// --- Tables --------------------------------------------------------------------------------------

// ROW(F, layer, name, text, help, channels, value, otherwise): the layers that are means over all camera rays, of what
// is seen in the end, also in mirrors and through glass; zero where nothing is.
//   layer, name      of C++'s Layer, and of the sum
//   text, help       of --layers
//   channels         the last letters of its channels' names
//   value            GLSL: what a ray adds that ends at the surface `s` with the Material `m`. tint: the colour that
//                    mirrors and glass on the way give
//   otherwise        GLSL: what one adds whose last mirror shows nothing. firstNormal: of the first surface
#define MEANS_OF_END(ROW, F) \
    ROW(F, Albedo, albedo, "albedo", "color in white light", "RGB", clamp(tint * albedoOf(m), 0.0, 1.0), clamp(tint, 0.0, 1.0)) \
    ROW(F, Normal, normal, "normal", "shading normal", "XYZ", shadingNormal(s), firstNormal)

// F(name, value, otherwise): a sum of vectors over the camera rays of a pixel.
#define SUM_OF_MEAN(F, layer, name, text, help, channels, value, otherwise) F(name, value, otherwise)
#define SUMS_OF_END(F) MEANS_OF_END(SUM_OF_MEAN, F)
/// Of the surface `s` that a ray meets first, and its Material `m`. tint: what media on the way leave; a ray that meets
/// nothing adds its own to the transmittance.
#define SUMS_OF_FIRST(F) F(position, s.position, vec3(0.0)) F(transmittance, tint, vec3(0.0))
#define SEEN_SUMS(F) SUMS_OF_FIRST(F) SUMS_OF_END(F)

// F(layer, text, help, channels, value): all layers.
//   value  C++: of a SeenPixel `s` of the host, the `scene` and the `camera` (host/render/layers.cpp)
#define LAYER_OF_MEAN(F, layer, name, text, help, channels, value, otherwise) F(layer, text, help, channels, meanOf(s.name, s.samples))
#define LAYER_LIST(F) \
    MEANS_OF_END(LAYER_OF_MEAN, F) \
    F(Depth, "depth", "metres along the camera's axis", "Z", depthOf(s, camera)) \
    F(Transmittance, "transmittance", "share of light that media leave", "RGB", meanOf(s.transmittance, s.samples)) \
    F(Position, "position", "in the world, metres", "XYZ", positionOf(s, scene)) \
    F(Uv, "uv", "first texture coordinates", "UV", uvOf(s, scene)) \
    F(Object, "object", "number of the mesh or sphere", "X", objectOf(s, scene)) \
    F(Material, "material", "number of the material", "X", materialOf(s, scene))

// --- Sums of a pixel -----------------------------------------------------------------------------

/// Behind the PixelState of a pixel, in the film of a kernel that sees; zero before its first ray.
struct SeenPixel {
    uint hits;      ///< camera rays that end on a surface
    float covered;  ///< the sum of their weights by the pixel filter
    uint primitive; ///< that the first hit found, in the Primitive buffer
    uint placement; ///< that the primitive is in, in Scene::placements; NO_SEEN_PLACEMENT: none
    float b1, b2;   ///< its barycentric weights (triangles), of the second and third corner there
    uint unused0, unused1;
#define DECLARE_SUM(name, value, otherwise) vec4 name;
    SEEN_SUMS(DECLARE_SUM)
#undef DECLARE_SUM
};

SHARED_CONST uint NO_SEEN_PLACEMENT = 0xFFFFFFFFu;

/// Its rows in the film: of what is before the sums, of those of the first surface, and of all.
#define COUNT_SUM(name, value, otherwise) +1u
SHARED_CONST uint SEEN_HEAD_ROWS = 2u;
SHARED_CONST uint SEEN_FIRST_ROWS = 0u SUMS_OF_FIRST(COUNT_SUM);
SHARED_CONST uint SEEN_ROWS = SEEN_HEAD_ROWS + SEEN_FIRST_ROWS SUMS_OF_END(COUNT_SUM);
#undef COUNT_SUM
SHARED_ROWS(SeenPixel, SEEN_ROWS);

SHARED_END

#endif
