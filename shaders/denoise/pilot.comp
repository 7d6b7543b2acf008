#version 460
// The pilot: a mean over the few neighbours on the same surface, what radiance is compared by in filter.comp. A pixel by
// itself has too much noise to be told from its neighbours.
#extension GL_GOOGLE_include_directive : require

#include "shared/denoise_types.h"
#include "denoise/rows.glsl"
ROWS_TO_READ(DENOISE_BINDING_PIXELS, pixelRows)
ROWS_TO_WRITE(DENOISE_BINDING_PILOTS, pilotRows)
#include "denoise/features.glsl"

DenoisePilot pilotOf(Place place) {
    const DenoisePixel own = fetchPixel(place.index);
    float sum = 0.0, sumOfSquares = 0.0, variance = 0.0;
    vec3 mean = vec3(0.0), deviation = vec3(0.0);
    for (int dy = -DENOISE_PILOT_REACH; dy <= DENOISE_PILOT_REACH; ++dy)
        for (int dx = -DENOISE_PILOT_REACH; dx <= DENOISE_PILOT_REACH; ++dx) {
            const bool isThere = isInPicture(place.x + dx, place.y + dy);
            const uint index = isThere ? indexBeside(place, dx, dy) : place.index;
            const DenoisePixel q = fetchPixel(index);
            const vec3 unlike = featureDifferences(own, q, float(dx), float(dy));
            const float weight = isThere ? q.weight * expOfNegative(0.5 * dot(unlike, DENOISE_PILOT_SCALE)) : 0.0;
            sum += weight;
            sumOfSquares += weight * weight;
            mean += weight * q.mean;
            deviation += weight * q.deviation;
            // A deviation is one number, and may be small by chance; halves know of clumps that samples hide.
            variance += weight * max(squareOf(q.deviation), fetchVariance(index));
        }
    const float inverse = sum > 0.0 ? 1.0 / sum : 0.0;
    // A half has twice the variance of the mean of both.
    return DenoisePilot(inverse * mean, 2.0 * variance * sumOfSquares * inverse * inverse * inverse, inverse * deviation,
                        variance * inverse / 3.0);
}

void main() {
    const Place place = placeOfInvocation();
    if (place.isNeeded) {
        const DenoisePilot pilot = pilotOf(place);
        WRITE_ROW(pilotRows, 2u * place.index, vec4(pilot.mean, pilot.variance));
        WRITE_ROW(pilotRows, 2u * place.index + 1u, vec4(pilot.deviation, pilot.noise));
    }
}
