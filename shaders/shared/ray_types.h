// Rays for shaders/trace_rays.comp, which `stromboli bench` measures traversal with.
#ifndef STROMBOLI_SHARED_RAY_TYPES_H
#define STROMBOLI_SHARED_RAY_TYPES_H

#include "interface.h"
#include "language.h"

SHARED_BEGIN

#define BINDING_RAYS BINDING_COUNT
#define BINDING_LANE_TOTALS (BINDING_COUNT + 1)
#define BINDING_RAY_DISTANCES (BINDING_COUNT + 2)

#define SPEC_ANY_HIT SPEC_COUNT               // stop at the first hit (shadow rays)
#define SPEC_WRITE_DISTANCES (SPEC_COUNT + 1) // where every ray ended, for comparisons

/// The part of origin + t direction with 0 < t < tMax.
struct TracedRay {
    vec3 origin;
    float tMax;
    vec3 direction;
    uint unused;
};
SHARED_ROWS(TracedRay, 2);

/// What a lane's rays found: few words, written once a lane and not once a ray.
struct LaneTotals {
    uint hits;
    float distances; ///< sum over closest hits of t
    uint unfinished; ///< 1: the lane met the loop limit with rays left
};

/// Push constants of one dispatch.
struct RayDispatch {
    uint rayCount;
    uint raysPerLane;
    uint hardIterations; ///< leave the loop here: an error
    uint chunkCount; ///< 0: a group for each chunk of rays; else groups take the next one of so many
};

SHARED_END

#endif
