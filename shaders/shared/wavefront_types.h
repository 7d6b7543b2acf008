// The wavefront scheduler (wavefront.comp, host/kernel/dispatcher.hpp): its stages and its queues.
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

#endif
