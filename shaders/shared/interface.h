// Numbers the host and the shaders agree on: bindings and specialisation constants.
#ifndef STROMBOLI_SHARED_INTERFACE_H
#define STROMBOLI_SHARED_INTERFACE_H

#include "language.h"

SHARED_BEGIN

// --- Bindings of the path kernel (set 0) -----------------------------------------------------
// As macros, since GLSL layout qualifiers of older compilers take literals only.
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
#define BINDING_SUSPENDED 10
#define BINDING_STATUS 11
#define BINDING_SPLITS 12 // of suspended paths
#define BINDING_FILTER 13 // the table of a pixel filter; read row by row as well
#define BINDING_COUNT 14
#define SCENE_BINDING_COUNT 7 // bindings 0 to 6 hold the scene and are read row by row

/// Numbers of rows in texel buffers are cut to these bits; no buffer has more rows (docs/kernel.md,
/// "Fetch").
SHARED_CONST uint TEXEL_ROW_MASK = 0x07FFFFFFu;

// --- Specialisation constants: only what a scene needs ---------------------------------------
#define SPEC_WORKGROUP_SIZE 0
#define SPEC_TRAVERSAL_STEPS 1 // traversal steps between two service passes
#define SPEC_STACK_SIZE 2      // proven sufficient by the BVH builder
#define SPEC_HAS_TRIANGLES 3
#define SPEC_HAS_SPHERES 4
#define SPEC_HAS_NORMALS 5
#define SPEC_BSDF_KINDS 6 // bit n: BSDF_ kind n occurs
#define SPEC_HAS_EMISSION 7
#define SPEC_LIGHT_KINDS 8 // bit n: lights of LIGHT_ kind n are sampled
#define SPEC_INTEGRATOR 9
#define SPEC_DIRECT_LIGHT 10
#define SPEC_ROULETTE 11
#define SPEC_ORTHOGRAPHIC 12
#define SPEC_CLIP_ALONG_RAY 13
#define SPEC_CS184 14
#define SPEC_LIGHT_GROUPS 15 // bit n: the light tree has lights of LIGHT_GROUP_ n
#define SPEC_LIGHT_SAMPLES 16 // per shading point (LIGHT_CHOICE_EACH: and light)
#define SPEC_COUNT_STEPS 17   // count how many lanes are at work in each step
#define SPEC_SAMPLER 18
#define SPEC_LIGHT_NUMBERS 19      // which random numbers light samples take
#define SPEC_LIGHT_CHOICE 20       // how one of the lights is picked
#define SPEC_MIS_LOBES 21 // LOBE_ bits: of these bounces find lights too, weighted
#define SPEC_SPLITS 22 // paths may split into branches
#define SPEC_GAP_PROPOSAL 23 // the gap proposal: some bounces go into the gap (gap_proposal.glsl)
#define SPEC_STACK_IN_REGISTERS 24 // else in a memory that each lane indexes
#define SPEC_LARGE_TREE 25 // the tree has more than SMALL_TREE_RECORDS records
#define SPEC_AMBIENT_BY_BOUNCES 26 // bounces alone find the ambient light; light samples go to others
#define SPEC_HAS_AMBIENT 27 // rays that hit nothing find ambient light
// Of the modules with RICH_MATERIALS alone:
#define SPEC_HAS_ENVIRONMENT 28 // that light is a picture
#define SPEC_HAS_BACKDROP 29    // the camera sees it
#define SPEC_HAS_LENS 30
#define SPEC_PIXEL_FILTER 31 // how samples are spread about a pixel
#define SPEC_TEXTURE_SLOTS 32 // bit n: some material has a texture in slot n (TEXTURE_)
#define SPEC_TEXEL_KINDS 33 // TEXEL_KIND_ bits that occur
#define SPEC_ATTRIBUTES 34 // ATTRIBUTE_ bits: what the detail buffer has of primitives' corners
#define SPEC_ALPHA 35 // surfaces may be partly not there
#define SPEC_TANGENT_FRAMES 36 // the frame of a BSDF follows the surface's tangent
#define SPEC_PRINCIPLED_FEATURES 37 // PRINCIPLED_HAS_ bits: what the principled materials have
#define SPEC_LOOSE_SLOTS 38 // bit n: some material has a texture in slot n that is in no bundle
#define SPEC_FACETS 39 // FACETS_ bits: of microfacets of conductors, dielectrics, plastic
#define SPEC_BLACK_BACKS 40 // materials are black where normals do not point
#define SPEC_BLENDS 41 // materials are mixtures of others
#define SPEC_FILTER_EXTRA 42 // a float: Gaussian and tent are wider by this share
#define SPEC_HIDES_SURFACES 43 // camera rays pass some materials (DETAIL_IS_HIDDEN)
#define SPEC_RELIEF_RULES 44   // some material has MATERIAL_RELIEF_ bits
#define SPEC_FLAT_TERMINATOR 48 // light is reflected from flat triangles (no terminator offset)
// Of the modules with PLACEMENTS alone:
#define SPEC_HAS_PLACEMENTS 45 // prototypes are placed in the world (scene_types.h)
#define SPEC_TRAVERSAL_LEGS 46 // between two service passes, each of SPEC_TRAVERSAL_STEPS
// Of all modules:
#define SPEC_ROULETTE_START 47 // bounces before roulette by throughput
// Of the modules with RICH_MATERIALS:
#define SPEC_LOOSE_TEXTURES 49 // the most textures that a material has in no bundle
#define SPEC_WAITING_PART 50 // lanes at surfaces wait until they are this part of those at work; 0: for none
#define SPEC_CORNER_NORMALS 51 // some triangle has normals of its corners; else maps alone make shading normals
#define SPEC_COUNT 52

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
SHARED_CONST float ROULETTE_MAX_CONTINUE = 0.95f;
SHARED_CONST float ROULETTE_BOLDNESS = 3.0f; // probability to go on, over throughput

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
