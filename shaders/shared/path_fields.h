// What of a path lies in memory: between two stages of the wavefront scheduler, or two dispatches of the persistent
// one. Code that loads and stores it (include/path_memory.glsl) and sizes of buffers (host/kernel/path_kernel.hpp) follow
// from this table.
#ifndef STROMBOLI_SHARED_PATH_FIELDS_H
#define STROMBOLI_SHARED_PATH_FIELDS_H

/// Who reads and who writes a field (below), as bits. A stage of the wavefront scheduler loads what it reads, of which
/// what it does not use is no longer in its kernel, and stores what it changes. Some occasions are told apart, so
/// that what they need does not take registers in all that a stage does.
#define BY_DEPART 1u
#define BY_TRACE 2u
#define BY_FOLLOW 4u
#define BY_LIGHT 8u
#define BY_SERVICE (BY_DEPART | BY_FOLLOW)
#define AT_ARRIVAL 16u // a path ray has met a surface, or a branch begins
#define AT_RESULT 128u // the ray of a light sample is done
#define AT_RETURN 32u  // a branch begins, where the path has split
#define AT_SPLIT 64u   // of STAGE_DEPART: the path splits
#define AT_PAUSE 256u  // persistent scheduler: a lane ends a dispatch, where it may be about to trace a path ray
#define BY_ALL (BY_DEPART | BY_TRACE | BY_FOLLOW | BY_LIGHT)
#define ALWAYS 0xFFFFFFFFu // all of these

/// Fields, by their readers, that the persistent scheduler keeps from one dispatch to the next: all, where a lane may
/// stop before any ray, else those that a path ray needs.
#define KEPT_BETWEEN_DISPATCHES (STOPS_BEFORE_ANY_RAY ? ALWAYS : AT_PAUSE)

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
    F(uint, point.placement, exists && HAS_PLACEMENTS, readers, writers) \
    F(uint, point.mixture, exists && MOST_OTHERS != 0u, readers, writers) \
    F(uint, point.table, exists && GUIDES_LIGHT, readers, writers)

/// What a ray goes through (medium.glsl).
#define FILLING_FIELDS(F, filling, exists, readers, writers) \
    F(uint, filling.medium, exists, readers, writers) \
    F(uint, filling.volumes, exists && mediaDo(MEDIA_OVERLAP), readers, writers) \
    F(uint, filling.around, exists && mediaDo(MEDIA_OVERLAP), readers, writers)

/// The rows of a material (fetch.glsl).
#define MATERIAL_FIELDS(F, of, exists, readers, writers) \
    F(uvec4, of.header, exists, readers, writers) \
    F(uvec4, of.row1, exists, readers, writers) \
    F(uvec4, of.row2, exists && materialsHaveRow(2u), readers, writers) \
    F(uvec4, of.row3, exists && materialsHaveRow(3u), readers, writers) \
    F(uvec4, of.row4, exists && materialsHaveRow(4u), readers, writers) \
    F(uvec4, of.row5, exists && materialsHaveRow(5u), readers, writers) \
    F(uvec4, of.row6, exists && materialsHaveRow(6u), readers, writers) \
    F(uvec4, of.row7, exists && sceneHas(LOBE_DIFFUSE_TRANSMISSION), readers, writers) \
    F(uvec4, of.row8, exists && HAS_IRIDESCENCE, readers, writers)

/// F(type, member, exists, readers, writers): all of a path (path_state.glsl) and of its place in the work list that
/// the next stage, or the next dispatch, has to find. exists: whether the scene's kernels have the field.
#define PATH_FIELDS(F) \
    F(uint, job.item, true, BY_ALL | AT_PAUSE, BY_DEPART | AT_PAUSE) \
    F(uint, job.target, true, BY_ALL, BY_DEPART) \
    F(uint, path.phase, true, BY_ALL | AT_PAUSE, BY_SERVICE | BY_LIGHT | AT_PAUSE) \
    F(uint, path.bounce, true, BY_ALL | AT_PAUSE, BY_SERVICE | AT_PAUSE) \
    F(uint, path.uncounted, mediaDo(MEDIA_UNDER_SURFACE), BY_ALL | AT_PAUSE, BY_SERVICE | AT_PAUSE) \
    F(vec3, path.ray.origin, true, BY_ALL | AT_PAUSE, BY_SERVICE | BY_LIGHT | AT_PAUSE) \
    F(vec3, path.ray.direction, true, BY_ALL | AT_PAUSE, BY_SERVICE | BY_LIGHT | AT_PAUSE) \
    F(float, path.ray.tMin, true, BY_ALL, BY_SERVICE | BY_LIGHT) \
    F(float, path.ray.tMax, true, BY_ALL, BY_SERVICE | BY_LIGHT | BY_TRACE) \
    F(float, path.rayEnd, true, BY_ALL, BY_SERVICE | BY_LIGHT) \
    F(uint, path.ray.skipPrimitive, true, BY_ALL | AT_PAUSE, BY_SERVICE | BY_LIGHT | AT_PAUSE) \
    F(uint, path.ray.skipPlacement, HAS_PLACEMENTS, BY_ALL | AT_PAUSE, BY_SERVICE | BY_LIGHT | AT_PAUSE) \
    F(uint, path.ray.passed, HAS_ALPHA, BY_ALL, BY_SERVICE | BY_LIGHT) \
    F(uint, path.ray.passedPlacement, HAS_ALPHA && HAS_PLACEMENTS, BY_ALL, BY_SERVICE) \
    F(uint, path.ray.hitPrimitive, true, BY_ALL, BY_TRACE) \
    F(float, path.ray.b1, true, BY_ALL, BY_TRACE) \
    F(float, path.ray.b2, true, BY_ALL, BY_TRACE) \
    F(uint, path.ray.hitPlacement, HAS_PLACEMENTS, BY_ALL, BY_TRACE) \
    F(vec3, path.throughput, true, BY_ALL | AT_PAUSE, BY_SERVICE | AT_PAUSE) \
    F(vec3, path.radiance, true, BY_ALL | AT_PAUSE, BY_SERVICE | AT_PAUSE) \
    F(float, path.brightness, endsByThroughput(), BY_ALL | AT_PAUSE, BY_SERVICE | AT_PAUSE) \
    FILLING_FIELDS(F, path.filling, true, BY_ALL | AT_PAUSE, BY_SERVICE | AT_PAUSE) \
    FILLING_FIELDS(F, path.shadowFilling, MEDIA != 0u, BY_FOLLOW, BY_FOLLOW | BY_LIGHT) \
    FILLING_FIELDS(F, path.crossing.filling, MEDIA != 0u && HAS_ALPHA, BY_FOLLOW, BY_SERVICE | BY_LIGHT) \
    F(float, path.crossing.error, MEDIA != 0u && HAS_ALPHA, BY_FOLLOW, BY_SERVICE | BY_LIGHT) \
    F(bool, path.crossing.isUntold, MEDIA != 0u && HAS_ALPHA, BY_FOLLOW, BY_SERVICE | BY_LIGHT) \
    F(bool, path.countsEmission, true, BY_ALL | AT_PAUSE, BY_SERVICE | AT_PAUSE) \
    F(float, path.bouncePdf, true, BY_ALL | AT_PAUSE, BY_DEPART | BY_LIGHT | AT_PAUSE) \
    F(uint, path.aim.place, AIMS_BOUNCES, BY_ALL | AT_PAUSE, BY_DEPART | AT_PAUSE) \
    F(float, path.aim.bsdfPdf, AIMS_BOUNCES, BY_ALL | AT_PAUSE, BY_DEPART | AT_PAUSE) \
    F(float, path.aim.weight, AIMS_BOUNCES, BY_ALL | AT_PAUSE, BY_SERVICE | AT_PAUSE) \
    F(vec3, path.departureNormal, true, BY_ALL | AT_PAUSE, BY_DEPART | BY_LIGHT | AT_PAUSE) \
    F(vec3, path.departurePoint, PORTALS != 0u || LIGHT_THROUGH_GLASS, BY_ALL | AT_PAUSE, BY_SERVICE | BY_LIGHT | AT_PAUSE) \
    F(uint, path.departureTable, GUIDES_LIGHT, BY_ALL | AT_PAUSE, BY_DEPART | BY_LIGHT | AT_PAUSE) \
    F(vec3, path.glass.direction, LIGHT_THROUGH_GLASS, BY_ALL | AT_PAUSE, BY_SERVICE | BY_LIGHT | AT_PAUSE) \
    F(bool, path.glass.isFromLit, LIGHT_THROUGH_GLASS, BY_ALL | AT_PAUSE, BY_SERVICE | AT_PAUSE) \
    F(uint, path.glass.panes, LIGHT_THROUGH_GLASS, BY_ALL | AT_PAUSE, BY_SERVICE | AT_PAUSE) \
    F(bool, path.glass.isUnderWay, LIGHT_THROUGH_GLASS, BY_ALL | AT_PAUSE, BY_SERVICE | AT_PAUSE) \
    F(uint, path.glass.light, LIGHT_THROUGH_GLASS, BY_FOLLOW, BY_LIGHT) \
    F(vec3, path.glass.share, LIGHT_THROUGH_GLASS, BY_FOLLOW, BY_LIGHT) \
    SURFACE_FIELDS(F, path.glass.surface, LIGHT_THROUGH_GLASS, BY_FOLLOW, BY_FOLLOW) \
    MATERIAL_FIELDS(F, path.glass.material, LIGHT_THROUGH_GLASS, BY_FOLLOW, BY_FOLLOW) \
    F(vec3, path.glass.throughput, LIGHT_THROUGH_GLASS, BY_FOLLOW, BY_FOLLOW) \
    F(uint, path.glass.bounce, LIGHT_THROUGH_GLASS, BY_FOLLOW, BY_FOLLOW) \
    FILLING_FIELDS(F, path.glass.filling, LIGHT_THROUGH_GLASS, BY_FOLLOW, BY_FOLLOW) \
    F(vec3, path.firstNormal, SEES_SURFACES, BY_ALL | AT_PAUSE, BY_FOLLOW | AT_PAUSE) \
    F(vec3, path.arrivalNumbers, true, BY_ALL | AT_PAUSE, BY_DEPART | AT_PAUSE) \
    F(float, path.filterWeight, samplesHaveWeights(), BY_ALL | AT_PAUSE, BY_DEPART | AT_PAUSE) \
    F(uint, path.directIndex, true, BY_ALL, BY_FOLLOW | BY_LIGHT) \
    F(vec3, path.directValue, true, BY_ALL, BY_FOLLOW | BY_LIGHT) \
    F(uint, path.sampledSky, findsSkyOnArrival(), BY_FOLLOW, BY_LIGHT) \
    F(uint, path.sampledEmitter.material, emissionHasFactors(), BY_ALL, BY_LIGHT) \
    F(uint, path.sampledEmitter.primitive, emissionHasFactors(), BY_ALL, BY_LIGHT) \
    F(vec2, path.sampledEmitter.weights, emissionHasFactors(), BY_ALL, BY_LIGHT) \
    SURFACE_FIELDS(F, path.surface, true, BY_DEPART | BY_LIGHT | AT_RESULT, AT_ARRIVAL) \
    MATERIAL_FIELDS(F, path.material, true, BY_DEPART | BY_LIGHT | AT_RESULT, AT_ARRIVAL) \
    F(vec3, path.splitPoint.throughput, SPLITS, AT_RETURN | AT_PAUSE, AT_SPLIT | AT_PAUSE) \
    F(uint, path.splitPoint.bounce, SPLITS, BY_ALL | AT_PAUSE, BY_DEPART | AT_PAUSE) \
    F(uint, path.splitPoint.uncounted, SPLITS && mediaDo(MEDIA_UNDER_SURFACE), AT_RETURN | AT_PAUSE, AT_SPLIT | AT_PAUSE) \
    FILLING_FIELDS(F, path.splitPoint.filling, SPLITS, AT_RETURN | AT_PAUSE, AT_SPLIT | AT_PAUSE) \
    SURFACE_FIELDS(F, path.splitPoint.surface, SPLITS, AT_RETURN | AT_PAUSE, AT_SPLIT | AT_PAUSE) \
    F(uint, path.branchesLeft, SPLITS, BY_ALL | AT_PAUSE, BY_SERVICE | AT_PAUSE) \
    F(uint, path.eventCount, RECORDS, BY_ALL | AT_PAUSE, BY_SERVICE | BY_LIGHT | AT_PAUSE)

#endif
