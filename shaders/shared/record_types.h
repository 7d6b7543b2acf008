// What a kernel that records (RECORDS) writes of the path of one sample: events, in the order in which they happen, behind
// the state of the only pixel of its film. The host makes vertices of them (host/kernel/recorded_path.hpp).
#ifndef STROMBOLI_SHARED_RECORD_TYPES_H
#define STROMBOLI_SHARED_RECORD_TYPES_H

#include "language.h"

SHARED_BEGIN

SHARED_CONST uint EVENT_CAMERA = 1u;  ///< the camera ray
SHARED_CONST uint EVENT_ARRIVAL = 2u; ///< a path ray has met a surface, or scatters in a medium
SHARED_CONST uint EVENT_MISS = 3u;    ///< a path ray has met nothing
SHARED_CONST uint EVENT_LIGHT = 4u;   ///< a sample of direct light
SHARED_CONST uint EVENT_BOUNCE = 5u;  ///< a direction to go on in

struct PathEvent {
    uint kind;
    uint branch;    ///< branches left + 1; 0: of the part that all share
    uint name;      ///< arrival: the primitive, in the Primitive buffer; light: as LightEntry::light; bounce: LOBE_ bit
    uint placement; ///< arrival: NO_SEEN_PLACEMENT, or in Scene::placements; light: 1 if a ray goes to it
    vec3 place;     ///< camera: where the ray begins; arrival; light: its point, of finite ones
    float distance; ///< camera: from which on the ray meets something; arrival: of the ray; bounce: roulette's number
    vec3 direction; ///< unit: of the ray
    float pdf; ///< by solid angle: light: of all samples together, or minus the probability of its choice; bounce. Arrival:
               ///< what the bounce weighs that has arrived, where only that tells (aimed_bounces.glsl)
    vec3 throughput; ///< arrival, light: before; bounce: after it and its roulette
    float weight;    ///< of what the path adds: MIS; camera: by the pixel filter; bounce: of all that follows
    vec3 light;      ///< what the sample's radiance gains
    float roulette;  ///< arrival and bounce: the probability of going on; light: 1 if it arrives
};
SHARED_CONST uint EVENT_ROWS = 5u;
SHARED_ROWS(PathEvent, EVENT_ROWS);
SHARED_OFFSET(PathEvent, throughput, 48);

SHARED_CONST uint MOST_EVENTS = 4096u; ///< further ones are counted only
SHARED_CONST uint NO_NAME = 0xFFFFFFFFu;

SHARED_END

#endif
