#version 460
// Blends the noisy picture and the candidates so that the error which the window's moments predict is least.
#extension GL_GOOGLE_include_directive : require

#include "shared/denoise_types.h"
#include "denoise/rows.glsl"
ROWS_TO_READ(DENOISE_BINDING_PIXELS, pixelRows)
ROWS_TO_READ(DENOISE_BINDING_CANDIDATES, candidateRows)
ROWS_TO_READ(DENOISE_BINDING_MOMENTS, momentRows)
ROWS_TO_READ(DENOISE_BINDING_SUMS, sumRows)
ROWS_TO_WRITE(DENOISE_BINDING_RESULTS, resultRows)
#include "denoise/features.glsl"

DenoiseMoments momentsOf(vec4 r0, vec4 r1, vec4 r2) {
    return DenoiseMoments(r0.x, r0.y, r0.z, r0.w, r1.x, r1.y, r1.z, r1.w, r2.x, r2.y, r2.z, r2.w);
}

/// All pixels of the window but the one in its middle, whose own error has no say in its shares: so what its moments say
/// of the error with these is right on the mean.
DenoiseMoments windowAround(Place place) {
    vec4 s0 = vec4(0.0), s1 = vec4(0.0), s2 = vec4(0.0);
    for (int d = -DENOISE_WINDOW_REACH; d <= DENOISE_WINDOW_REACH; ++d) {
        const bool rowIsThere = d != 0 && isInPicture(place.x, place.y + d);
        const uint row = 3u * (rowIsThere ? indexBeside(place, 0, d) : place.index);
        const float rows = rowIsThere ? 1.0 : 0.0;
        s0 += rows * ROW(sumRows, row);
        s1 += rows * ROW(sumRows, row + 1u);
        s2 += rows * ROW(sumRows, row + 2u);
        const bool besideIsThere = d != 0 && isInPicture(place.x + d, place.y);
        const uint beside = 3u * (besideIsThere ? indexBeside(place, d, 0) : place.index);
        const float times = besideIsThere ? 1.0 : 0.0;
        s0 += times * ROW(momentRows, beside);
        s1 += times * ROW(momentRows, beside + 1u);
        s2 += times * ROW(momentRows, beside + 2u);
    }
    return momentsOf(s0, s1, s2);
}

/// By what the pixel's noise exceeds, or falls short of, that of its window: the root of the quotient, as it is one pixel's.
/// Samples that have met no light say nothing of it.
float noisinessOf(DenoisePixel own, float variance, DenoiseMoments alone, DenoiseMoments window) {
    const bool isSilent = variance == 0.0 && own.mean == vec3(0.0);
    const float around = window.spread / max(window.pixels, 1.0);
    return isSilent || around <= 0.0 ? 1.0 : max(sqrt(alone.spread / around), DENOISE_LEAST_NOISINESS);
}

/// The window's moments if its pixels had so many times the noise, and candidates the errors that they have: what is left
/// of a product without the noise, taken0 + taken1 - error of it, is theirs.
DenoiseMoments withNoise(DenoiseMoments m, float times) {
    const float more = times - 1.0;
    m.product00 += more * (2.0 * m.taken0 - m.error);
    m.product01 += more * (m.taken0 + m.taken1 - m.error);
    m.product02 += more * (m.taken0 + m.taken2 - m.error);
    m.product11 += more * (2.0 * m.taken1 - m.error);
    m.product12 += more * (m.taken1 + m.taken2 - m.error);
    m.product22 += more * (2.0 * m.taken2 - m.error);
    m.taken0 *= times;
    m.taken1 *= times;
    m.taken2 *= times;
    m.error *= times;
    return m;
}

/// The share of a candidate that makes the error least while the others stay: `taken` is what is left for it to take,
/// `room` what the others leave of 1.
float shareOf(float taken, float product, float room) {
    // No 0 / 0 where nothing would change. A candidate that follows the noise, as one does that finds no neighbours, takes
    // none of a pixel's excess, and less than nothing may be left of its product.
    const float best = product >= 0.0 ? taken / ((1.0 + DENOISE_RIDGE) * product + 1e-30) : 0.0;
    return clamp(best, 0.0, max(room, 0.0));
}

/// Shares from 0 to 1, together at most 1, by coordinate descent: what they minimise is convex.
vec3 sharesOf(DenoiseMoments m) {
    vec3 s = vec3(0.0);
    for (int sweep = 0; sweep < DENOISE_SWEEPS; ++sweep) {
        s.x = shareOf(m.taken0 - m.product01 * s.y - m.product02 * s.z, m.product00, 1.0 - s.y - s.z);
        s.y = shareOf(m.taken1 - m.product01 * s.x - m.product12 * s.z, m.product11, 1.0 - s.x - s.z);
        s.z = shareOf(m.taken2 - m.product02 * s.x - m.product12 * s.y, m.product22, 1.0 - s.x - s.y);
    }
    return s;
}

/// The two parts of the squared error that is left with these shares.
vec2 errorWith(DenoiseMoments m, vec3 s) {
    const float noise = m.error - 2.0 * (m.taken0 * s.x + m.taken1 * s.y + m.taken2 * s.z);
    const float change = m.product00 * s.x * s.x + m.product11 * s.y * s.y + m.product22 * s.z * s.z +
                         2.0 * (m.product01 * s.x * s.y + m.product02 * s.x * s.z + m.product12 * s.y * s.z);
    return vec2(noise, change);
}

DenoiseCandidate fetchCandidate(uint place, uint number) {
    const uint row = 6u * place + 2u * number;
    const vec4 change = ROW(candidateRows, row);
    return DenoiseCandidate(change.xyz, change.w, ROW(candidateRows, row + 1u).xyz, 0.0);
}

/// What an error is compared with where it is stated: what the wide candidate makes of either half, on the mean. One bright
/// sample makes an error large and, without that, what it is compared with too, and the relative error small.
vec3 statedCountOf(DenoisePixel own, DenoiseCandidate wide) {
    const vec3 even = own.mean + wide.change;
    return 0.5 * (countOf(own, even + wide.deviation) + countOf(own, even - wide.deviation));
}

void main() {
    const Place place = placeOfInvocation();
    if (place.isNeeded) {
        const DenoisePixel own = fetchPixel(place.index);
        const DenoiseCandidate c0 = fetchCandidate(place.index, 0u), c1 = fetchCandidate(place.index, 1u),
                               c2 = fetchCandidate(place.index, 2u);
        const DenoiseMoments window = windowAround(place);
        const uint row = 3u * place.index;
        const DenoiseMoments alone =
            momentsOf(ROW(momentRows, row), ROW(momentRows, row + 1u), ROW(momentRows, row + 2u));
        const float noisiness = noisinessOf(own, fetchVariance(place.index), alone, window);
        const vec3 shares = sharesOf(withNoise(window, noisiness));
        // What is not known has no share in the picture: the widest candidate takes its place.
        const vec3 seen = own.weight > 0.0 ? shares : vec3(shares.xy, 1.0 - shares.x - shares.y);
        const vec3 mean = own.mean + seen.x * c0.change + seen.y * c1.change + seen.z * c2.change;

        // Half of what the blends of the two halves differ by: the noise that is left.
        const float rest = 1.0 - shares.x - shares.y - shares.z;
        const vec3 left = rest * own.deviation + shares.x * c0.deviation + shares.y * c1.deviation + shares.z * c2.deviation;
        const vec3 chosenBy = countOf(own, own.mean + c1.change), stated = statedCountOf(own, c2);
        const float noise = c0.noise * dot(stated, vec3(1.0)) / dot(chosenBy, vec3(1.0));
        const float variance = dot(stated, left * left) / 3.0;
        const vec2 ofWindow = errorWith(window, shares) / max(window.pixels, 1.0) * noise / 3.0;
        const vec2 ofPixel = errorWith(alone, shares) * noise / 3.0;
        WRITE_ROW(resultRows, 3u * place.index, vec4(mean, ofPixel.x));
        WRITE_ROW(resultRows, 3u * place.index + 1u, vec4(shares, ofPixel.y));
        WRITE_ROW(resultRows, 3u * place.index + 2u, vec4(ofWindow, own.weight * variance, 0.0));
    }
}
