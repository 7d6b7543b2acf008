// What happens to the path of one sample, event by event (shared/record_types.h): kernels with RECORDS, whose film has one
// pixel. Behind its state are a row with the number of events, and the events.

#include "shared/record_types.h"

uint rowOfEvent(uint event) { return PIXEL_STATE_ROWS + 1u + EVENT_ROWS * event; }

void record(inout PathState path, PathEvent e) {
    if (path.eventCount < MOST_EVENTS) {
        const uint row = rowOfEvent(path.eventCount);
        const uint branch = SPLITS && path.splitPoint.bounce != 0u ? path.branchesLeft + 1u : 0u;
        STORE_ROW(pixelRows, row, uvec4(e.kind, branch, e.name, e.placement));
        STORE_ROW(pixelRows, row + 1u, floatBitsToUint(vec4(e.place, e.distance)));
        STORE_ROW(pixelRows, row + 2u, floatBitsToUint(vec4(e.direction, e.pdf)));
        STORE_ROW(pixelRows, row + 3u, floatBitsToUint(vec4(e.throughput, e.weight)));
        STORE_ROW(pixelRows, row + 4u, floatBitsToUint(vec4(e.light, e.roulette)));
    }
    ++path.eventCount;
    STORE_ROW(pixelRows, PIXEL_STATE_ROWS, uvec4(path.eventCount, 0u, 0u, 0u));
}

PathEvent eventOf(uint kind, PathState path) {
    PathEvent e;
    e.kind = kind;
    e.branch = 0u;
    e.name = NO_NAME;
    e.placement = NO_SEEN_PLACEMENT;
    e.place = path.ray.origin;
    e.distance = path.ray.tMax;
    e.direction = path.ray.direction;
    e.pdf = 0.0;
    e.throughput = path.throughput;
    e.weight = 1.0;
    e.light = vec3(0.0);
    e.roulette = 1.0;
    return e;
}

void recordCamera(inout PathState path) {
    PathEvent e = eventOf(EVENT_CAMERA, path);
    e.distance = path.ray.tMin;
    e.weight = path.filterWeight;
    record(path, e);
}

/// goesOn: the probability of roulette there; aimed: aimedWeight() of the bounce that has arrived.
void recordArrival(inout PathState path, vec3 light, float weight, float goesOn, float aimed) {
    PathEvent e = eventOf(EVENT_ARRIVAL, path);
    if (path.surface.primitive != NO_PRIMITIVE) e.name = path.surface.primitive;
    if (HAS_PLACEMENTS && path.surface.placement != NO_PLACEMENT)
        e.placement = fetchPlacement(path.surface.placement).placement & ~PLACEMENT_MIRRORS;
    e.place = path.surface.position;
    e.pdf = aimed;
    e.weight = weight;
    e.light = light;
    e.roulette = goesOn;
    record(path, e);
}

void recordMiss(inout PathState path, vec3 light, float weight) {
    PathEvent e = eventOf(EVENT_MISS, path);
    e.weight = weight;
    e.light = light;
    record(path, e);
}

/// goes: whether a ray is traced to it.
void recordLightSample(inout PathState path, LightSample light, float weight, bool goes) {
    PathEvent e = eventOf(EVENT_LIGHT, path);
    e.name = path.recordedLight;
    e.placement = goes ? 1u : 0u;
    e.place = light.target;
    const vec3 from = isBehind(path.surface, light.direction) ? path.surface.position : litPoint(path.surface);
    e.distance = light.infinite ? INFINITE_DISTANCE : length(light.target - from);
    e.direction = light.direction;
    e.pdf = path.recordedPdf;
    e.weight = weight;
    e.roulette = 0.0;
    record(path, e);
}

/// The ray of the last light sample has arrived, and added that much.
void recordArrivedLight(PathState path, vec3 light) {
    if (path.eventCount <= MOST_EVENTS)
        STORE_ROW(pixelRows, rowOfEvent(path.eventCount - 1u) + 4u, floatBitsToUint(vec4(light, 1.0)));
}

/// The throughput is that after the bounce but before its roulette, which goes by `largest`; mixtureWeight: of both
/// proposals, where the bounce's density is not that of the mixture.
void recordBounce(inout PathState path, BsdfSample b, float largest, float number, float mixtureWeight) {
    PathEvent e = eventOf(EVENT_BOUNCE, path);
    if (endsByThroughput() && path.bounce >= ROULETTE_START)
        e.roulette = survival(path, largest);
    e.name = b.lobe;
    e.place = path.surface.position;
    e.distance = number;
    e.direction = b.direction;
    e.pdf = isDelta(b.lobe) ? 0.0 : b.pdf;
    e.throughput = path.throughput * (mixtureWeight / max(e.roulette, TINY));
    if (AIMS_BOUNCES) e.weight = mixtureWeight;
    record(path, e);
}
