#version 460
// A candidate that is a regression: of the radiance of the pixels around, of each half of the samples by itself, as a
// linear function of what layers show of them and of their places. A pixel at an edge shows a part of each surface, and
// its radiance, albedo and normal are the same blend of theirs: so it is told from its neighbours without being like them.
#extension GL_GOOGLE_include_directive : require

#include "shared/denoise_types.h"
#include "denoise/rows.glsl"
ROWS_TO_READ(DENOISE_BINDING_PIXELS, pixelRows)
ROWS_TO_READ(DENOISE_BINDING_PILOTS, pilotRows)
ROWS_TO_WRITE(DENOISE_BINDING_REGRESSIONS, regressionRows)
#define READS_PILOTS
#include "denoise/features.glsl"

const int FEATURES = 6; // albedo, three of the normal, and two of the place; the constant comes after them

/// The normal equations of a half: sums of weighted products of the features, which are those of (albedo, normal), of the
/// place and 1, and of these with the radiance.
struct Equations {
    vec4 surface0, surface1, surface2, surface3; ///< of albedo and normal, by columns
    vec4 byX, byY, byOne;                        ///< of albedo and normal with the others
    vec3 ofPlace;                                ///< x x, x y, y y
    vec2 placeByOne;
    float one;
    vec4 red, green, blue; ///< radiance with albedo and normal
    vec3 radianceByX, radianceByY, radiance;
};

Equations noEquations() {
    return Equations(vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec4(0.0), vec3(0.0), vec2(0.0), 0.0,
                     vec4(0.0), vec4(0.0), vec4(0.0), vec3(0.0), vec3(0.0), vec3(0.0));
}

void add(inout Equations e, float weight, vec4 surface, vec2 at, vec3 radiance) {
    const vec4 weighted = weight * surface;
    const vec2 weightedAt = weight * at;
    const vec3 seen = weight * radiance;
    e.surface0 += weighted * surface.x;
    e.surface1 += weighted * surface.y;
    e.surface2 += weighted * surface.z;
    e.surface3 += weighted * surface.w;
    e.byX += weighted * at.x;
    e.byY += weighted * at.y;
    e.byOne += weighted;
    e.ofPlace += vec3(weightedAt.x * at, weightedAt.y * at.y);
    e.placeByOne += weightedAt;
    e.one += weight;
    e.red += surface * seen.x;
    e.green += surface * seen.y;
    e.blue += surface * seen.z;
    e.radianceByX += at.x * seen;
    e.radianceByY += at.y * seen;
    e.radiance += seen;
}

/// The constant of the solution: the radiance where all features are 0, at the pixel itself. Elimination takes the features
/// one after the other; of the matrix, which is symmetric, what is below the diagonal is kept.
vec3 constantOf(Equations e) {
    const float ridge = DENOISE_REGRESSION_RIDGE * e.one;
    float m[(FEATURES + 1) * (FEATURES + 1)];
    vec3 r[FEATURES + 1];
    const vec4 columns[4] = vec4[4](e.surface0, e.surface1, e.surface2, e.surface3);
    for (int i = 0; i < 4; ++i) {
        for (int j = 0; j < 4; ++j) m[7 * i + j] = columns[j][i];
        m[7 * 4 + i] = e.byX[i];
        m[7 * 5 + i] = e.byY[i];
        m[7 * 6 + i] = e.byOne[i];
        r[i] = vec3(e.red[i], e.green[i], e.blue[i]);
    }
    m[7 * 4 + 4] = e.ofPlace.x;
    m[7 * 5 + 4] = e.ofPlace.y;
    m[7 * 5 + 5] = e.ofPlace.z;
    m[7 * 6 + 4] = e.placeByOne.x;
    m[7 * 6 + 5] = e.placeByOne.y;
    m[7 * 6 + 6] = e.one;
    r[4] = e.radianceByX;
    r[5] = e.radianceByY;
    r[6] = e.radiance;
    for (int k = 0; k < FEATURES; ++k) {
        // In exact numbers what is left of a product is at least the ridge.
        const float inverse = 1.0 / (max(m[8 * k], 0.0) + ridge);
        for (int i = k + 1; i <= FEATURES; ++i) {
            const float factor = m[7 * i + k] * inverse;
            for (int j = k + 1; j <= i; ++j) m[7 * i + j] -= factor * m[7 * j + k];
            r[i] -= factor * r[k];
        }
    }
    // What is left of the constant's is at least the pixel's own weight, 1, and small only if it is unknown.
    return r[6] / max(m[8 * 6], 1e-3 * e.one);
}

void main() {
    const Place place = placeOfInvocation();
    if (place.isNeeded) {
        const DenoisePixel own = fetchPixel(place.index);
        const DenoisePilot pilot = fetchPilot(place.index);
        Equations first = noEquations(), second = noEquations();
        for (int dy = -DENOISE_REGRESSION_REACH; dy <= DENOISE_REGRESSION_REACH; ++dy)
            for (int dx = -DENOISE_REGRESSION_REACH; dx <= DENOISE_REGRESSION_REACH; ++dx) {
                const bool isThere = isInPicture(place.x + dx, place.y + dy);
                const uint index = isThere ? indexBeside(place, dx, dy) : place.index;
                const DenoisePixel q = fetchPixel(index);
                const vec2 unlikely = DENOISE_LOOSE_COLOR * excess(pilot, fetchPilot(index));
                const float distance = DENOISE_REGRESSION_DISTANCE * float(dx * dx + dy * dy);
                const float times = isThere ? q.weight : 0.0;
                const vec3 albedo = max(q.albedo, vec3(DENOISE_LEAST_ALBEDO));
                const vec4 surface = vec4(dot(q.albedo - own.albedo, vec3(1.0 / 3.0)), q.normal - own.normal);
                const vec2 at = DENOISE_REGRESSION_STEP * vec2(dx, dy);
                add(first, times * expOfNegative(distance + unlikely.x), surface, at, (q.mean + q.deviation) * albedo);
                add(second, times * expOfNegative(distance + unlikely.y), surface, at, (q.mean - q.deviation) * albedo);
            }
        const vec3 albedo = max(own.albedo, vec3(DENOISE_LEAST_ALBEDO));
        const vec3 a = first.one > 0.0 ? constantOf(first) / albedo : vec3(0.0);
        const vec3 b = second.one > 0.0 ? constantOf(second) / albedo : vec3(0.0);
        WRITE_ROW(regressionRows, 2u * place.index, vec4(0.5 * (a + b) - own.mean, 0.0));
        WRITE_ROW(regressionRows, 2u * place.index + 1u, vec4(0.5 * (a - b), 0.0));
    }
}
