// The path kernel's specialisation constants: one table, of which GLSL makes the constants and C++ their numbers.
// The host derives their values from the scene, the settings and the device (host/kernel/kernel_features.cpp), and
// what they switch off is not in the scene's kernel (host/spirv).
#ifndef STROMBOLI_SHARED_FEATURES_H
#define STROMBOLI_SHARED_FEATURES_H

#include "language.h"

/// Of the workgroup; GLSL names it in a layout only.
#define SPEC_WORKGROUP_SIZE 0

/// C(number, type, name, default): the default holds where the host gives no value (tests of single functions).
#define KERNEL_CONSTANTS(C) \
    C(1, uint, TRAVERSAL_STEPS, 8u) /* traversal steps between two service passes */ \
    C(2, uint, STACK_SIZE, 64u) /* proven sufficient by the BVH builder */ \
    C(3, bool, HAS_TRIANGLES, true) /* the scene has triangles */ \
    C(4, bool, HAS_SPHERES, true) /* the scene has spheres */ \
    C(5, bool, HAS_NORMALS, true) /* some surface has a shading normal beside its geometric one */ \
    C(6, uint, CLOSURES, 33554431u) /* LOBE_ and closure bits that some material has (bsdf_types.h) */ \
    C(7, bool, HAS_EMISSION, true) /* some surface shines */ \
    C(8, uint, LIGHT_KINDS, 255u) /* bit n: lights of LIGHT_ kind n are sampled */ \
    C(9, uint, INTEGRATOR, INTEGRATOR_PATH) /* what a sample is (INTEGRATOR_) */ \
    C(10, uint, DIRECT_LIGHT, DIRECT_LIGHTS) /* how lights are found from a surface (DIRECT_) */ \
    C(11, uint, ROULETTE, ROULETTE_THROUGHPUT) /* ROULETTE_ mode */ \
    C(12, bool, ORTHOGRAPHIC, false) /* the camera is orthographic */ \
    C(13, bool, CLIP_ALONG_RAY, false) /* the near and far distances are along the ray, not along the axis */ \
    C(14, bool, CS184, false) /* the CS184 renderer's shading conventions */ \
    C(15, uint, LIGHT_GROUPS, 7u) /* bit n: the light tree has lights of LIGHT_GROUP_ n */ \
    C(16, uint, LIGHT_SAMPLES, 1u) /* per shading point (LIGHT_CHOICE_EACH: and light) */ \
    C(17, bool, COUNT_STEPS, false) /* count how many lanes are at work in each step */ \
    C(18, uint, SAMPLER, SAMPLER_INDEPENDENT) /* SAMPLER_ kind */ \
    C(19, uint, LIGHT_NUMBERS, LIGHT_NUMBERS_FIRST) /* which random numbers light samples take */ \
    C(20, uint, LIGHT_CHOICE, LIGHT_CHOICE_TREE) /* how one of the lights is picked */ \
    C(21, uint, MIS_LOBES, 0u) /* LOBE_ bits: of these bounces find lights too, weighted */ \
    C(22, bool, SPLITS, false) /* paths may split into branches */ \
    C(23, bool, GAP_PROPOSAL, false) /* the gap proposal: some bounces go into the gap (gap_proposal.glsl) */ \
    C(24, bool, STACK_IN_REGISTERS, false) /* else in a memory that each lane indexes */ \
    C(25, bool, LARGE_TREE, false) /* the tree has more than SMALL_TREE_RECORDS records */ \
    C(26, bool, AMBIENT_BY_BOUNCES, false) /* bounces alone find the ambient light; light samples go to others */ \
    C(27, bool, HAS_AMBIENT, true) /* rays that hit nothing find ambient light */ \
    C(28, bool, HAS_ENVIRONMENT, true) /* that light is a picture */ \
    C(29, bool, HAS_BACKDROP, true) /* the camera sees it */ \
    C(30, bool, HAS_LENS, false) /* the camera has a lens of some radius */ \
    C(31, uint, PIXEL_FILTER, FILTER_BOX) /* how samples are spread about a pixel */ \
    C(32, uint, TEXTURE_SLOTS, 0u) /* bit n: some material has a texture in slot n (TEXTURE_) */ \
    C(33, uint, TEXEL_KINDS, 8191u) /* TEXEL_KIND_ bits that occur */ \
    C(34, uint, ATTRIBUTES, 0u) /* ATTRIBUTE_ bits: what the detail buffer has of primitives' corners */ \
    C(35, bool, HAS_ALPHA, false) /* surfaces may be partly not there */ \
    C(36, bool, TANGENT_FRAMES, false) /* the frame of a BSDF follows the surface's tangent */ \
    C(37, uint, CLOSURES_OF_ALL, 0u) /* those of these that all materials have which they concern */ \
    C(38, uint, LOOSE_SLOTS, 0u) /* bit n: some material has a texture in slot n that is in no bundle */ \
    C(39, bool, BLACK_BACKS, false) /* materials are black where normals do not point */ \
    C(40, bool, HAS_BLENDS, false) /* materials are mixtures of others */ \
    C(41, float, FILTER_EXTRA, 0.0) /* a float: Gaussian and tent are wider by this share */ \
    C(42, bool, HIDES_SURFACES, false) /* camera rays pass some materials (DETAIL_IS_HIDDEN) */ \
    C(43, bool, RELIEF_RULES, false) /* some material has MATERIAL_RELIEF_ bits */ \
    C(44, bool, HAS_PLACEMENTS, false) /* prototypes are placed in the world (scene_types.h) */ \
    C(45, uint, TRAVERSAL_LEGS, 1u) /* between two service passes, each of SPEC_TRAVERSAL_STEPS */ \
    C(46, uint, ROULETTE_START, 3u) /* bounces before roulette by throughput */ \
    C(47, bool, FLAT_TERMINATOR, false) /* light is reflected from flat triangles (no terminator offset) */ \
    C(48, uint, LOOSE_TEXTURES, 255u) /* the most textures that a material has in no bundle */ \
    C(49, bool, CORNER_NORMALS, true) /* some triangle has normals of its corners; else maps alone make shading normals */

#define SPEC_COUNT 50

#ifdef __cplusplus
namespace stromboli {
#define KERNEL_CONSTANT_NUMBER(number, type, name, standard) SPEC_##name = number,
enum KernelConstant : uint32_t { KERNEL_CONSTANTS(KERNEL_CONSTANT_NUMBER) };
#undef KERNEL_CONSTANT_NUMBER
#define KERNEL_CONSTANT_COUNT(number, type, name, standard) +1
static_assert(SPEC_COUNT == 1 KERNEL_CONSTANTS(KERNEL_CONSTANT_COUNT));
#undef KERNEL_CONSTANT_COUNT
} // namespace stromboli
#endif

#endif
