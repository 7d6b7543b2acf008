#version 460
// Two candidates that are means over neighbours that are alike, of each half of the samples by itself; and from these and
// the regression (regress.comp) the moments that say how the candidates are best blended (docs/theory/denoising.md).
#extension GL_GOOGLE_include_directive : require

#include "shared/denoise_types.h"
#include "denoise/rows.glsl"
ROWS_TO_READ(DENOISE_BINDING_TAPS, tapRows)
ROWS_TO_READ(DENOISE_BINDING_PIXELS, pixelRows)
ROWS_TO_READ(DENOISE_BINDING_PILOTS, pilotRows)
ROWS_TO_READ(DENOISE_BINDING_REGRESSIONS, regressionRows)
ROWS_TO_WRITE(DENOISE_BINDING_CANDIDATES, candidateRows)
ROWS_TO_WRITE(DENOISE_BINDING_MOMENTS, momentRows)
#define READS_PILOTS
#include "denoise/features.glsl"

DenoiseTap fetchTap(uint index) {
    const vec4 r0 = ROW(tapRows, 2u * index), r1 = ROW(tapRows, 2u * index + 1u);
    return DenoiseTap(r0.x, r0.y, r0.z, r0.w, r1.x, 0.0, 0.0, 0.0);
}

/// Sums of weighted radiance and of the weights, of either half of the samples.
struct Halves {
    vec3 first, second;
    float firstWeight, secondWeight;
};

void add(inout Halves h, float first, float second, DenoisePixel q) {
    h.first += first * (q.mean + q.deviation);
    h.second += second * (q.mean - q.deviation);
    h.firstWeight += first;
    h.secondWeight += second;
}

/// What has been gathered for the two means of a pixel. Each half goes by its own pilot: what it becomes knows nothing
/// of the other half.
struct Gathered {
    Halves strict, wide;
};

Gathered gather(Place place, DenoisePixel own, DenoisePilot pilot) {
    const Halves none = Halves(vec3(0.0), vec3(0.0), 0.0, 0.0);
    Gathered g = Gathered(none, none);
    for (uint t = 0u; t < dispatch.tapCount; ++t) {
        const DenoiseTap tap = fetchTap(t);
        const int dx = int(tap.dx), dy = int(tap.dy);
        const bool isThere = isInPicture(place.x + dx, place.y + dy);
        const uint index = isThere ? indexBeside(place, dx, dy) : place.index;
        const DenoisePixel q = fetchPixel(index);
        const DenoisePilot other = fetchPilot(index);
        const vec3 unlike = featureDifferences(own, q, tap.dx, tap.dy);
        const float times = isThere ? q.weight * tap.times : 0.0;

        const vec2 unlikely = excess(pilot, other);
        const vec2 a = tap.strict + 0.5 * dot(unlike, DENOISE_STRICT_SCALE) + DENOISE_STRICT_COLOR * unlikely;
        const vec2 b = tap.wide + 0.5 * dot(unlike, DENOISE_WIDE_SCALE) + DENOISE_LOOSE_COLOR * unlikely;
        add(g.strict, times * expOfNegative(a.x), times * expOfNegative(a.y), q);
        add(g.wide, times * expOfNegative(b.x), times * expOfNegative(b.y), q);
    }
    return g;
}

DenoiseCandidate candidateOf(DenoisePixel own, Halves h) {
    const vec3 a = h.firstWeight > 0.0 ? h.first / h.firstWeight : vec3(0.0);
    const vec3 b = h.secondWeight > 0.0 ? h.second / h.secondWeight : vec3(0.0);
    return DenoiseCandidate(0.5 * (a + b) - own.mean, 0.0, 0.5 * (a - b), 0.0);
}

void store(uint place, uint number, DenoiseCandidate c) {
    WRITE_ROW(candidateRows, 6u * place + 2u * number, vec4(c.change, c.noise));
    WRITE_ROW(candidateRows, 6u * place + 2u * number + 1u, vec4(c.deviation, 0.0));
}

void main() {
    const Place place = placeOfInvocation();
    if (place.isNeeded) {
        const DenoisePixel own = fetchPixel(place.index);
        const DenoisePilot pilot = fetchPilot(place.index);
        const Gathered g = gather(place, own, pilot);
        DenoiseCandidate c0 = candidateOf(own, g.strict);
        const DenoiseCandidate c2 = candidateOf(own, g.wide);
        const DenoiseCandidate c1 = DenoiseCandidate(ROW(regressionRows, 2u * place.index).xyz, 0.0,
                                                     ROW(regressionRows, 2u * place.index + 1u).xyz, 0.0);
        // Errors count relative to the radiance, as relMSE has it, of which the regression says how large it is, since it
        // takes no light over an edge; and to the noise that the neighbours say the pixel has, so that one of them does
        // not decide for all.
        const vec3 relative = countOf(own, own.mean + c1.change);
        const float noise = sqrt(dot(relative, vec3(pilot.noise)) + DENOISE_LEAST_NOISE);
        const vec3 count = own.weight / noise * relative;
        c0.noise = noise;
        store(place.index, 0u, c0);
        store(place.index, 1u, c1);
        store(place.index, 2u, c2);
        const vec3 taken0 = own.deviation * (own.deviation - c0.deviation);
        const vec3 taken1 = own.deviation * (own.deviation - c1.deviation);
        const vec3 taken2 = own.deviation * (own.deviation - c2.deviation);
        const uint row = 3u * place.index;
        WRITE_ROW(momentRows, row,
                  vec4(dot(count, c0.change * c0.change), dot(count, c0.change * c1.change),
                       dot(count, c0.change * c2.change), dot(count, c1.change * c1.change)));
        WRITE_ROW(momentRows, row + 1u,
                  vec4(dot(count, c1.change * c2.change), dot(count, c2.change * c2.change), dot(count, taken0),
                       dot(count, taken1)));
        WRITE_ROW(momentRows, row + 2u,
                  vec4(dot(count, taken2), dot(count, own.deviation * own.deviation), own.weight,
                       dot(count, vec3(fetchVariance(place.index) / 3.0))));
    }
}
