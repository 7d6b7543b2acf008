// Numbers the host and the shaders agree on: bindings, and values of specialisation constants.
#ifndef STROMBOLI_SHARED_INTERFACE_H
#define STROMBOLI_SHARED_INTERFACE_H

#include "features.h"
#include "language.h"

SHARED_BEGIN

// --- Bindings of the path kernel (set 0) -----------------------------------------------------
// Bindings are macros, since GLSL layout qualifiers of older compilers take literals only.
#define BINDING_RECORDS 0
#define BINDING_PRIMITIVES 1
#define BINDING_MATERIALS 2
#define BINDING_LIGHTS 3
#define BINDING_LIGHT_TABLE 4
#define BINDING_ENVIRONMENT 5
#define BINDING_DETAIL 6 // attributes of corners and texels (texture_types.h)
#define BINDING_FRAME 7
#define BINDING_WORK_ITEMS 8
#define BINDING_PIXELS 9
#define BINDING_PATHS 10 // states of paths (path_fields.h)
#define BINDING_STATUS 11
#define BINDING_FILTER 12 // the table of a pixel filter; read row by row as well
#define BINDING_GUIDE 13    // by what samples choose where they go: the guide (guide_types.h) or lit cells (light_types.h); the shadow map
#define BINDING_QUEUES 14   // of the wavefront scheduler alone
#define BINDING_COUNT 15
#define SCENE_BINDING_COUNT 7 // bindings 0 to 6 hold the scene and are read row by row

/// Numbers of rows in texel buffers are cut to these bits; no buffer has more rows (docs/theory/kernel.md,
/// "Fetch").
SHARED_CONST uint TEXEL_ROW_MASK = 0x07FFFFFFu;

// --- Values of specialisation constants (features.h) -----------------------------------------
SHARED_CONST uint TEXEL_KIND_NEAREST = 1u;
SHARED_CONST uint TEXEL_KIND_BILINEAR = 2u;
SHARED_CONST uint TEXEL_KIND_SRGB = 4u;
SHARED_CONST uint TEXEL_KIND_BYTES = 8u;
SHARED_CONST uint TEXEL_KIND_HALF = 16u;
SHARED_CONST uint TEXEL_KIND_BUNDLE = 32u;
SHARED_CONST uint TEXEL_KIND_LOOSE = 64u; ///< some texture is in no bundle
SHARED_CONST uint TEXEL_KIND_REPEAT = 128u; ///< a wrap mode of some texture, in one direction or both
SHARED_CONST uint TEXEL_KIND_MIRROR = 256u;
SHARED_CONST uint TEXEL_KIND_CLAMP = 512u;
SHARED_CONST uint TEXEL_KIND_ADJUSTED = 1024u; ///< some texture's coordinates are transformed, or its scale is not 1
SHARED_CONST uint TEXEL_KIND_PLAIN = 2048u; ///< some texture's texels lie one after the other (TEXELS_PLAIN)
SHARED_CONST uint TEXEL_KIND_GATHERED = 4096u; ///< some texture's do not

SHARED_CONST uint INTEGRATOR_PATH = 0u;
SHARED_CONST uint INTEGRATOR_NORMALS = 1u;
SHARED_CONST uint INTEGRATOR_DEPTH = 2u;
SHARED_CONST uint INTEGRATOR_COVERAGE = 3u; ///< whether there is a surface (layer_types.h)
SHARED_CONST uint INTEGRATOR_LAYERS = 4u;   ///< and what is seen of it

SHARED_CONST uint DIRECT_LIGHTS = 0u;
SHARED_CONST uint DIRECT_HEMISPHERE = 1u;
SHARED_CONST uint DIRECT_BSDF = 2u;

SHARED_CONST uint FILTER_BOX = 0u;
SHARED_CONST uint FILTER_GAUSSIAN = 1u;
SHARED_CONST uint FILTER_BLACKMAN_HARRIS = 2u;
SHARED_CONST uint FILTER_TENT = 3u; ///< of radius 1
SHARED_CONST uint FILTER_TABLE = 4u; ///< of cells that FilterCell describes; samples have weights
SHARED_CONST uint FILTER_CELLS = 4096u;
/// In pixels; of the Gaussian, what lies beyond four standard deviations is left out.
SHARED_CONST float GAUSSIAN_DEVIATION = 0.5f;
SHARED_CONST float GAUSSIAN_RADIUS = 2.0f;
SHARED_CONST float BLACKMAN_HARRIS_RADIUS = 1.5f;

SHARED_CONST uint SAMPLER_INDEPENDENT = 0u;
SHARED_CONST uint SAMPLER_SOBOL = 1u;

SHARED_CONST uint LIGHT_NUMBERS_FIRST = 1u;  ///< the first at a surface shares the block of the path ray
SHARED_CONST uint LIGHT_NUMBERS_SHARED = 2u; ///< there is no other

SHARED_CONST uint LIGHT_CHOICE_ONE = 0u;  ///< there is a single light
SHARED_CONST uint LIGHT_CHOICE_TREE = 1u; ///< by what it is likely to bring to the surface
SHARED_CONST uint LIGHT_CHOICE_POWER = 2u;
SHARED_CONST uint LIGHT_CHOICE_UNIFORM = 3u;
SHARED_CONST uint LIGHT_CHOICE_EACH = 4u; ///< all of them in turn

SHARED_CONST uint ROULETTE_NONE = 0u;
SHARED_CONST uint ROULETTE_THROUGHPUT = 1u;
SHARED_CONST uint ROULETTE_FIXED = 2u;
SHARED_CONST float ROULETTE_BOLDNESS = 3.0f;   // probability to go on, over throughput
SHARED_CONST float ROULETTE_BRIGHTNESS = 4.0f; // likewise, times how bright it is beside the sample (roulette.glsl)

/// A stretch of a pixel filter along columns or rows, one of FILTER_CELLS that are met equally often.
struct FilterCell {
    float begin; ///< from the pixel's middle, pixels
    float width;
    float weight; ///< of samples in it: the filter's integral over it, of FILTER_CELLS times the mean
    uint unused;
};
SHARED_ROWS(FilterCell, 1);

SHARED_END

#endif
