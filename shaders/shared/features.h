// The path kernel's features: one table, from which GLSL has the specialisation constants, C++ their numbers, their
// values for a scene and the lines of `stromboli info` (host/kernel/kernel_features.cpp), and the tests that switch
// every feature on and off (tests/spirv). What is switched off is not in the scene's kernel.
#ifndef STROMBOLI_SHARED_FEATURES_H
#define STROMBOLI_SHARED_FEATURES_H

#include "conventions.h"
#include "language.h"

/// The size of the workgroup; GLSL names it in a layout only.
#define SPEC_WORKGROUP_SIZE 0

// F(number, type, name, standard, value, all, label, shown, adds):
//   standard  what holds where the host gives no value (tests of single functions)
//   value     C++: how it follows from `scene`, `camera`, `settings` and `tuning`. `shades`: surfaces scatter light,
//             which they do not in pictures of normals and distances. f[SPEC_NAME]: the value of a row above.
//   all       C++: the value where the kernel is to have all that a scene might need; `own`: as for the scene
//   label     of the line of `info`
//   shown     how the value reads there: flag; bits or oneOf, with a name for each bit or choice; count, with a unit;
//             share; number
//   adds      what the feature adds to the kernel
#define KERNEL_FEATURES(F) \
    F(3, bool, HAS_TRIANGLES, true, scene.hasTriangles, 1, \
      "triangles", flag, "the intersection of rays and triangles") \
    F(4, bool, HAS_SPHERES, true, scene.hasSpheres, 1, \
      "spheres", flag, "the intersection of rays and spheres") \
    F(58, bool, SPHERES_WAIT, false, !tuning.stepsBranch && spheresWait(scene), own, \
      "spheres that wait", flag, "spheres that are tested after some steps, where most steps meet none") \
    F(45, bool, HAS_PLACEMENTS, false, scene.hasPlacements, own, \
      "instances", flag, "prototypes that are placed in the world: rays go into their space and back") \
    F(25, bool, LARGE_TREE, false, f[SPEC_HAS_PLACEMENTS] || scene.bvh.records.size() > gpu::SMALL_TREE_RECORDS, 1, \
      "a large tree", flag, \
        "groups of children of two words, which number more records than one can, or tell the world from prototypes") \
    F(2, uint, STACK_SIZE, 64u, std::max(scene.bvh.stackSize, 1u), own, \
      "traversal stack", count("entries"), \
        "room for the groups of children that a traversal puts off; proven sufficient by the BVH builder") \
    F(24, bool, STACK_IN_REGISTERS, false, f[SPEC_STACK_SIZE] <= tuning.registerStack, own, \
      "traversal stack in registers", flag, \
        "a stack that moves as a whole, in place of a memory that each lane indexes") \
    F(6, uint, CLOSURES, 0xFFFFFFFFu, shades ? scene.closures.some : 0, gpu::CLOSURE_MASK, \
      "materials", bits(kClosures), "the closures of materials, and the recipes by which they follow from parameters") \
    F(37, uint, CLOSURES_OF_ALL, 0u, shades ? scene.closures.some & scene.closures.all : 0, 0u, \
      "all materials", bits(kClosures), "no choice between materials that have these and materials that have not") \
    F(53, bool, HAS_DISPERSION, true, shades && scene.hasDispersion, own, \
      "dispersion", flag, "volumes that refract each colour in its own direction") \
    F(54, bool, HAS_IRIDESCENCE, true, shades && scene.hasIridescence, own, \
      "iridescence", flag, "interference in thin films on surfaces") \
    F(41, bool, HAS_BLENDS, false, shades && scene.hasBlends, own, \
      "mixtures of materials", flag, "the choice of one of two materials at a hit") \
    F(51, uint, MOST_OTHERS, 0u, shades ? scene.mostOthers : 0, own, \
      "materials evaluated beside the chosen one", count(""), \
        "the other materials of a mixture, looked up and evaluated for each light sample and bounce") \
    F(40, bool, BLACK_BACKS, false, shades && scene.hasBlackBacks, own, \
      "black backs", flag, "materials that are black where normals do not point") \
    F(52, uint, MEDIA, 0u, shades ? scene.media : 0, own, \
      "media", bits(kMedia), "what rays go through between surfaces: points where paths scatter, and what is left of light") \
    F(35, bool, HAS_ALPHA, false, scene.hasAlpha, own, \
      "opacity", flag, "surfaces that are partly not there, which rays pass") \
    F(50, bool, STOPS_BEFORE_ANY_RAY, false, \
        (f[SPEC_HAS_ALPHA] || (f[SPEC_MEDIA] & gpu::MEDIA_VARY)) && tuning.limitsLoops, own, \
      "stops before any ray", flag, \
        "paths that are kept whole between dispatches, so that a ray passes any number of surfaces where loops are limited") \
    F(43, bool, HIDES_SURFACES, false, scene.hasHidden, own, \
      "surfaces hidden from the camera", flag, "camera rays that pass some materials") \
    F(32, uint, TEXTURE_SLOTS, 0u, scene.textureSlots & texturesWanted(scene, shades), own, \
      "textures", bits(kTextureSlots), "lookups for these parameters of materials") \
    F(38, uint, LOOSE_SLOTS, 0u, scene.looseSlots & texturesWanted(scene, shades), own, \
      "textures by themselves", bits(kTextureSlots), "lookups of textures that are in no bundle") \
    F(49, uint, LOOSE_TEXTURES, 255u, f[SPEC_LOOSE_SLOTS] ? scene.mostTextures : 0, own, \
      "most textures of a material", count("by themselves"), \
        "a loop over the textures of a material that are in no bundle") \
    F(33, uint, TEXEL_KINDS, 8191u, scene.texelKinds, own, \
      "texels", bits({"nearest", "bilinear", "sRGB", "bytes", "half floats", "bundled", "not bundled", "repeated", \
        "mirrored", "clamped", "transformed", "line after line", "gathered"}), \
        "ways in which texels are stored, found and decoded") \
    F(34, uint, ATTRIBUTES, 0u, scene.attributes, own, \
      "attributes of corners", bits({"texture coordinates", "second texture coordinates", "colors", "tangents"}), \
        "attributes of corners that are interpolated") \
    F(39, bool, CORNER_NORMALS, true, scene.hasNormals, 1, \
      "normals of corners", flag, "normals of corners that are interpolated, and the terminator offset") \
    F(5, bool, HAS_NORMALS, true, scene.hasNormals || (shades && (scene.textureSlots & kNormalMaps) != 0), 1, \
      "shading normals", flag, "a shading normal beside the geometric one, from corners or maps") \
    F(36, bool, TANGENT_FRAMES, false, shades && scene.hasTangentFrames, own, \
      "tangents", flag, "frames of BSDFs that follow the surface's tangent") \
    F(44, bool, RELIEF_RULES, false, shades && scene.hasReliefRules, own, \
      "rules of relief", flag, \
        "materials with rules of their own for relief (MATERIAL_RELIEF_ bits, DETAIL_MIRRORS_RELIEF)") \
    F(7, bool, HAS_EMISSION, true, shades && scene.hasEmission, 1, \
      "emission", flag, "surfaces that shine") \
    F(9, uint, INTEGRATOR, INTEGRATOR_PATH, integratorConstant(settings.integrator), own, \
      "integrator", oneOf({"path", "normals", "depth", "coverage", "layers"}), "what a sample is") \
    F(10, uint, DIRECT_LIGHT, DIRECT_LIGHTS, directLightConstant(settings.directLight), own, \
      "direct light", oneOf({"light sampling", "uniform hemisphere", "left to bounces (delta lights sampled)"}), \
        "how lights are found from a surface") \
    F(8, uint, LIGHT_KINDS, 0xFFFFFFFFu, lightKinds(scene, settings), (1u << gpu::LIGHT_KIND_COUNT) - 1, \
      "lights", bits(kLights), "the sampling of these kinds of lights") \
    F(20, uint, LIGHT_CHOICE, LIGHT_CHOICE_TREE, lightChoiceConstant(scene.lights), own, \
      "choice of lights", oneOf({"there is one", "by a tree of them", "by power", "uniform", "each in turn"}), \
        "how a light sample picks its light") \
    F(15, uint, LIGHT_GROUPS, 7u, scene.lights.groups, own ? (1u << gpu::LIGHT_GROUP_COUNT) - 1 : 0, \
      "tree of lights", bits({"near", "unattenuated", "infinitely far"}), "groups of lights that the tree has") \
    F(65, bool, LIGHT_TREES_BRANCH, true, scene.lights.levels > 0, 1, \
      "groups of several lights", flag, "the walk down the tree of a group, whose root is else its only light") \
    F(16, uint, LIGHT_SAMPLES, 1u, directSampling(scene.lights, settings).perLight, own, \
      "light samples", count("at a surface"), \
        "a loop over the light samples at a surface; where lights are taken in turn, over those of each light") \
    F(19, uint, LIGHT_NUMBERS, LIGHT_NUMBERS_FIRST, lightNumbers(scene, settings), gpu::LIGHT_NUMBERS_FIRST, \
      "random numbers of light samples", oneOf({"of their own", "the first as the bounce", "as the bounce"}), \
        "which random numbers light samples take") \
    F(21, uint, MIS_LOBES, 0u, shades ? misLobes(scene, settings) : 0, own | \
        (combinesBouncesAndLightSamples(settings) ? gpu::GLOSSY_LOBES : 0), \
      "light shared with bounces (MIS) from", bits(kLobes), \
        "weights of light that both light samples and bounces from these lobes find") \
    F(27, bool, HAS_AMBIENT, true, shades && scene.lights.hasAmbient, 1, \
      "ambient light", flag, "light that rays find which hit nothing") \
    F(28, bool, HAS_ENVIRONMENT, true, shades && scene.lights.environment != nullptr, 1, \
      "environment", flag, "ambient light that is a picture") \
    F(29, bool, HAS_BACKDROP, true, shades && scene.lights.hasBackdrop && settings.showsBackdrop, own, \
      "ambient light seen by the camera", flag, "ambient light behind the scene") \
    F(26, bool, AMBIENT_BY_BOUNCES, false, shades && scene.lights.ambientLeftToBounces, own, \
      "ambient light left to bounces", flag, \
        "ambient light that bounces alone find, while light samples go to other lights") \
    F(18, uint, SAMPLER, SAMPLER_INDEPENDENT, settings.sampler == Sampler::Sobol ? gpu::SAMPLER_SOBOL : \
        gpu::SAMPLER_INDEPENDENT, own, \
      "sampler", oneOf({"independent", "sobol"}), "how the random numbers of a pixel's samples are drawn") \
    F(11, uint, ROULETTE, ROULETTE_THROUGHPUT, rouletteConstant(scene, settings), own, \
      "roulette", oneOf({"none", "by throughput", "fixed probability"}), "how paths are ended at random") \
    F(47, uint, ROULETTE_START, 3u, f[SPEC_ROULETTE] == gpu::ROULETTE_THROUGHPUT ? settings.roulette.throughputStart \
        : 0, own, \
      "roulette by throughput", count("bounces from the camera and farther"), \
        "the bounce from which on throughput ends paths") \
    F(22, bool, SPLITS, false, settings.branches > 1, own, \
      "paths with branches", flag, "paths that split at the first surface that scatters at random") \
    F(23, bool, GAP_PROPOSAL, false, proposesGap(scene, settings), own, \
      "bounces into the gap behind the light", flag, "a second density of bounces (gap_proposal.glsl)") \
    F(12, bool, ORTHOGRAPHIC, false, camera.orthographic, own, \
      "orthographic camera", flag, "parallel camera rays") \
    F(13, bool, CLIP_ALONG_RAY, false, camera.clipAlongRay, own, \
      "clipping along rays", flag, "near and far distances along the ray, not along the axis") \
    F(30, bool, HAS_LENS, false, camera.lensRadius > 0, own, \
      "camera with a lens", flag, "camera rays from points of a lens") \
    F(31, uint, PIXEL_FILTER, FILTER_BOX, filterConstant(settings.filter), own, \
      "pixel filter", oneOf({"box", "Gaussian", "Blackman-Harris", "tent", \
        "negative in places, samples have weights"}), "how samples are spread about a pixel") \
    F(42, float, FILTER_EXTRA, 0.0, settings.filterShape.width - 1, own, \
      "filter wider by", share, "Gaussian and tent filters of another width") \
    F(14, uint, DEPARTURES, 0u, departures(settings.conventions), own, \
      "other conventions of shading", bits(kDepartures), "rules of shading that are not those of physics") \
    F(48, bool, FLAT_TERMINATOR, false, scene.hasNormals && settings.conventions.facesForward && \
        !settings.conventions.offsetsTerminator, own, \
      "no terminator offset", flag, "light that smooth meshes reflect from their flat triangles") \
    F(17, bool, COUNT_STEPS, false, tuning.countSteps, own, \
      "counts of steps", flag, "counts of the lanes at work in each step") \
    F(46, uint, TRAVERSAL_LEGS, 1u, scene.hasPlacements ? tuning.traversalLegs : 1, own, \
      "legs between two services", count(""), "rays that are prepared anew between two service passes") \
    F(1, uint, TRAVERSAL_STEPS, 8u, traversalSteps(f, scene, tuning), own, \
      "traversal steps in a leg", count(""), "traversal steps between two service passes, or in a leg") \
    F(55, bool, STEPS_BRANCH, false, tuning.stepsBranch, own, \
      "steps that branch", flag, "branches around what a step of the traversal does with a node and with a leaf") \
    F(56, bool, RECORDS, false, false, own, \
      "record of a path", flag, "what happens to the path of one sample, written event by event (render --pixel)") \
    F(57, bool, GUIDES_LIGHT, false, guidesLight(scene, settings), own, \
      "guided light samples", flag, "light samples that go where the environment is seen from") \
    F(59, bool, CLAMPS_INDIRECT, false, shades && settings.indirectLimit > 0, own, \
      "limited light", flag, "light that is limited where it was scattered twice or more") \
    F(60, float, INDIRECT_LIMIT, 1.0, f[SPEC_CLAMPS_INDIRECT] ? settings.indirectLimit : 0, own, \
      "limit of that light", number, "the most that it brings at a time, in its brightest channel") \
    F(61, uint, FOCI, 0u, shades && samplesLights(settings.directLight) ? scene.foci : 0, own, \
      "lamps near rays in media", count(""), "distances in media that are drawn about lamps") \
    F(62, uint, PORTALS, 0u, aimsAtPortals(scene, settings) ? scene.portals.all.size() : 0, own, \
      "portals", count(""), "light samples to the sky that aim at windows") \
    F(63, uint, STRANDS, 0u, tuning.strands > 1 ? tuning.strands : 0, own, \
      "lanes at a pixel", count(""), "strands of a pixel's samples, each with sums of its own (PixelState)") \
    F(64, bool, AIMS_BOUNCES, false, aimsBounces(scene, settings), own, \
      "bounces that aim at what lamps light", flag, "a second density of bounces (aimed_bounces.glsl)") \
    F(66, bool, LIGHT_THROUGH_GLASS, false, lightsThroughGlass(scene, settings), own, \
      "light samples through glass", flag, "rays of light samples that go on, bent, where they meet clear glass") \
    F(67, uint, OCCLUDERS, 0u, occludersLookedAt(scene, settings), own, \
      "occluders", count(""), "rectangles of walls that are looked at before a light sample's ray is traced") \
    F(68, bool, ROWS_REACH_POLES, false, f[SPEC_HAS_ENVIRONMENT] && scene.lights.environment && \
        scene.lights.environment->rows.reachPoles, own, \
      "environment whose rows reach the poles", flag, "rows of texels whose middles are the zenith and the nadir") \
    F(69, bool, SHADOW_MAP, false, looksAtShadowMap(scene, settings), own, \
      "shadow map", flag, "places that a sun surely does not reach, looked up before a light sample's ray is traced")

#define SPEC_COUNT 70

#ifdef __cplusplus
namespace stromboli {
#define FEATURE_NUMBER(number, type, name, standard, value, all, label, shown, adds) SPEC_##name = number,
enum KernelConstant : uint32_t { KERNEL_FEATURES(FEATURE_NUMBER) };
#undef FEATURE_NUMBER
#define FEATURE_COUNT(number, type, name, standard, value, all, label, shown, adds) +1
static_assert(SPEC_COUNT == 1 KERNEL_FEATURES(FEATURE_COUNT));
#undef FEATURE_COUNT
} // namespace stromboli
#endif

#endif
