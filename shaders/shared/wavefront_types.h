// The wavefront scheduler (wavefront.comp, host/kernel/wavefront_dispatcher.hpp): its stages, its queues, and
// what of a path lies in memory between two stages.
#ifndef STROMBOLI_SHARED_WAVEFRONT_TYPES_H
#define STROMBOLI_SHARED_WAVEFRONT_TYPES_H

#include "features.h"
#include "language.h"

#define SPEC_STAGE SPEC_COUNT // STAGE_ number: which of the stages the kernel is

SHARED_BEGIN

SHARED_CONST uint STAGE_BEGIN = 0u;  ///< each path wants a pixel of a new work list
SHARED_CONST uint STAGE_STOP = 1u;   ///< the render was stopped: samples under way are to be ended, or dropped
SHARED_CONST uint STAGE_DEPART = 2u; ///< changes pixels, draws camera rays and bounces
SHARED_CONST uint STAGE_TRACE = 3u;  ///< traces rays to their ends
SHARED_CONST uint STAGE_FOLLOW = 4u; ///< takes in what rays have met
SHARED_CONST uint STAGE_LIGHT = 5u;  ///< takes a light sample, which asks for a shadow ray
SHARED_CONST uint STAGE_COUNT = 6u;

SHARED_CONST uint QUEUE_DEPARTING = 0u; ///< paths that STAGE_DEPART is to serve
SHARED_CONST uint QUEUE_RAYS = 1u;      ///< and the one after it, in turn: paths with a ray to be traced
SHARED_CONST uint QUEUE_LIT = 3u;       ///< paths that STAGE_LIGHT is to serve
SHARED_CONST uint QUEUE_COUNT = 4u;

/// A queue's length, as the indirect dispatch over it reads it (VkDispatchIndirectCommand).
struct QueueHead {
    uint groups;
    uint one, alsoOne;
    uint count; ///< of paths in the queue
};
SHARED_ROWS(QueueHead, 1);

SHARED_END

/// Who reads and who writes a field (below), as bits. A stage loads what it reads, of which what it does not use is
/// no longer in its kernel, and stores what it changes. Some occasions are told apart, so that what they need
/// does not take registers in all that a stage does.
#define BY_DEPART 1u
#define BY_TRACE 2u
#define BY_FOLLOW 4u
#define BY_LIGHT 8u
#define BY_SERVICE (BY_DEPART | BY_FOLLOW)
#define AT_ARRIVAL 16u // a path ray has met a surface, or a branch begins
#define AT_RESULT 128u // the ray of a light sample is done
#define AT_RETURN 32u  // a branch begins, where the path has split
#define AT_SPLIT 64u   // of STAGE_DEPART: the path splits
#define BY_ALL (BY_DEPART | BY_TRACE | BY_FOLLOW | BY_LIGHT)

/// A point where a path scatters (surface.glsl). exists: whether a path may have such a point.
#define SURFACE_FIELDS(F, point, exists, readers, writers) \
    F(vec3, point.position, exists, readers, writers) \
    F(float, point.error, exists, readers, writers) \
    F(vec3, point.geometric, exists, readers, writers) \
    F(vec3, point.shading, exists && HAS_NORMALS, readers, writers) \
    F(vec3, point.wo, exists, readers, writers) \
    F(bool, point.outside, exists, readers, writers) \
    F(uint, point.material, exists, readers, writers) \
    F(uint, point.skipPrimitive, exists, readers, writers) \
    F(float, point.lift, exists && HAS_NORMALS, readers, writers) \
    F(uint, point.primitive, exists, readers, writers) \
    F(vec2, point.weights, exists, readers, writers) \
    F(vec4, point.tangent, exists && TANGENT_FRAMES, readers, writers) \
    F(vec3, point.coat, exists && sceneHasCoatNormals(), readers, writers) \
    F(uint, point.placement, exists && HAS_PLACEMENTS, readers, writers)

/// F(type, member, exists, readers, writers): all of a path (path_state.glsl) and of its place in the work list that
/// the next stage has to find. exists: whether the scene's kernels have the field.
#define PATH_FIELDS(F) \
    F(uint, job.item, true, BY_ALL, BY_DEPART) \
    F(uint, job.target, true, BY_ALL, BY_DEPART) \
    F(uint, path.phase, true, BY_ALL, BY_SERVICE | BY_LIGHT) \
    F(uint, path.bounce, true, BY_ALL, BY_SERVICE) \
    F(vec3, path.ray.origin, true, BY_ALL, BY_SERVICE | BY_LIGHT) \
    F(vec3, path.ray.direction, true, BY_ALL, BY_SERVICE | BY_LIGHT) \
    F(float, path.ray.tMin, true, BY_ALL, BY_SERVICE | BY_LIGHT) \
    F(float, path.ray.tMax, true, BY_ALL, BY_SERVICE | BY_LIGHT | BY_TRACE) \
    F(float, path.rayEnd, true, BY_ALL, BY_SERVICE | BY_LIGHT) \
    F(uint, path.ray.skipPrimitive, true, BY_ALL, BY_SERVICE | BY_LIGHT) \
    F(uint, path.ray.skipPlacement, HAS_PLACEMENTS, BY_ALL, BY_SERVICE | BY_LIGHT) \
    F(uint, path.ray.passed, HAS_ALPHA, BY_ALL, BY_SERVICE | BY_LIGHT) \
    F(uint, path.ray.passedPlacement, HAS_ALPHA && HAS_PLACEMENTS, BY_ALL, BY_SERVICE) \
    F(uint, path.ray.hitPrimitive, true, BY_ALL, BY_TRACE) \
    F(float, path.ray.b1, true, BY_ALL, BY_TRACE) \
    F(float, path.ray.b2, true, BY_ALL, BY_TRACE) \
    F(uint, path.ray.hitPlacement, HAS_PLACEMENTS, BY_ALL, BY_TRACE) \
    F(vec3, path.throughput, true, BY_ALL, BY_SERVICE) \
    F(vec3, path.radiance, true, BY_ALL, BY_SERVICE) \
    F(uint, path.medium, true, BY_ALL, BY_SERVICE) \
    F(bool, path.countsEmission, true, BY_ALL, BY_DEPART) \
    F(float, path.bouncePdf, true, BY_ALL, BY_DEPART) \
    F(vec3, path.departureNormal, true, BY_ALL, BY_DEPART) \
    F(vec3, path.arrivalNumbers, true, BY_ALL, BY_DEPART) \
    F(float, path.filterWeight, samplesHaveWeights(), BY_ALL, BY_DEPART) \
    F(uint, path.directIndex, true, BY_ALL, BY_FOLLOW | BY_LIGHT) \
    F(vec3, path.directValue, true, BY_ALL, BY_FOLLOW | BY_LIGHT) \
    F(uint, path.sampledEmitter.material, emissionHasFactors(), BY_ALL, BY_LIGHT) \
    F(uint, path.sampledEmitter.primitive, emissionHasFactors(), BY_ALL, BY_LIGHT) \
    F(vec2, path.sampledEmitter.weights, emissionHasFactors(), BY_ALL, BY_LIGHT) \
    SURFACE_FIELDS(F, path.surface, true, BY_DEPART | BY_LIGHT | AT_RESULT, AT_ARRIVAL) \
    F(uvec4, path.material.header, true, BY_DEPART | BY_LIGHT | AT_RESULT, AT_ARRIVAL) \
    F(uvec4, path.material.row1, true, BY_DEPART | BY_LIGHT | AT_RESULT, AT_ARRIVAL) \
    F(uvec4, path.material.row2, materialsHaveRow(2u), BY_DEPART | BY_LIGHT | AT_RESULT, AT_ARRIVAL) \
    F(uvec4, path.material.row3, materialsHaveRow(3u), BY_DEPART | BY_LIGHT | AT_RESULT, AT_ARRIVAL) \
    F(uvec4, path.material.row4, materialsHaveRow(4u), BY_DEPART | BY_LIGHT | AT_RESULT, AT_ARRIVAL) \
    F(uvec4, path.material.row5, materialsHaveRow(5u), BY_DEPART | BY_LIGHT | AT_RESULT, AT_ARRIVAL) \
    F(uvec4, path.material.row6, materialsHaveRow(6u), BY_DEPART | BY_LIGHT | AT_RESULT, AT_ARRIVAL) \
    F(vec3, path.splitPoint.throughput, SPLITS, AT_RETURN, AT_SPLIT) \
    F(uint, path.splitPoint.bounce, SPLITS, BY_ALL, BY_DEPART) \
    F(uint, path.splitPoint.medium, SPLITS, AT_RETURN, AT_SPLIT) \
    SURFACE_FIELDS(F, path.splitPoint.surface, SPLITS, AT_RETURN, AT_SPLIT) \
    F(uint, path.branchesLeft, SPLITS, BY_ALL, BY_SERVICE)

#ifdef __cplusplus
namespace stromboli {

/// The most 32-bit words that a path takes in memory, in the kernels of any scene.
constexpr uint32_t pathWords(bool SPLITS) {
    constexpr uint32_t uint = 1, float_ = 1, bool_ = 1, vec2 = 2, vec3 = 3, vec4 = 4, uvec4 = 4;
    constexpr bool HAS_NORMALS = true, TANGENT_FRAMES = true, HAS_PLACEMENTS = true, HAS_ALPHA = true;
    constexpr auto sceneHasCoatNormals = [] { return true; };
    constexpr auto samplesHaveWeights = [] { return true; };
    constexpr auto emissionHasFactors = [] { return true; };
    constexpr auto materialsHaveRow = [](uint32_t) { return true; };
    uint32_t words = 0;
#define float float_
#define bool bool_
#define ADD_WORDS(type, member, exists, readers, writers) words += (exists) ? type : 0;
    PATH_FIELDS(ADD_WORDS)
#undef ADD_WORDS
#undef bool
#undef float
    static_cast<void>(uvec4), static_cast<void>(vec4);
    return words;
}

} // namespace stromboli
#endif

#endif
