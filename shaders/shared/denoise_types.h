// What the denoiser's shaders (shaders/denoise) and the host exchange, and the numbers of the filter, which the shaders
// and the reference (host/denoise/reference_filter.cpp) have in common. docs/theory/denoising.md says what they mean.
#ifndef STROMBOLI_SHARED_DENOISE_TYPES_H
#define STROMBOLI_SHARED_DENOISE_TYPES_H

#include "language.h"

SHARED_BEGIN

// --- Bindings (set 0) of all of the denoiser's shaders, which are read or written row by row ------
#define DENOISE_BINDING_TAPS 0
#define DENOISE_BINDING_PIXELS 1
#define DENOISE_BINDING_PILOTS 2
#define DENOISE_BINDING_CANDIDATES 3
#define DENOISE_BINDING_MOMENTS 4
#define DENOISE_BINDING_SUMS 5
#define DENOISE_BINDING_RESULTS 6
#define DENOISE_BINDING_REGRESSIONS 7
#define DENOISE_BINDING_COUNT 8

#define DENOISE_GROUP_SIZE 64

// --- Pixels --------------------------------------------------------------------------------------

/// A pixel before it is filtered. Radiance is divided by albedo.
struct DenoisePixel {
    vec3 mean;
    float weight; ///< 1; 0: nothing is known of its radiance
    vec3 deviation; ///< mean + deviation and mean - deviation have errors that do not know each other
    float disparity; ///< 1 / depth; 0: nothing is seen
    vec3 albedo; ///< 1 where it is not known
    float slopeX; ///< of the disparity, by pixel
    vec3 normal;
    float slopeY;
    float variance; ///< of the mean, by the samples' own spread where that is known; summed over channels
    float unused0, unused1, unused2;
};
SHARED_ROWS(DenoisePixel, 5);

/// What a small filter that looks at surfaces alone makes of it: what its radiance is compared by.
struct DenoisePilot {
    vec3 mean;
    float variance; ///< of mean + deviation, and of mean - deviation, summed over channels
    vec3 deviation;
    float noise; ///< mean squared deviation of a pixel, by channel
};
SHARED_ROWS(DenoisePilot, 2);

/// A candidate beside the mean of a pixel.
struct DenoiseCandidate {
    vec3 change;      ///< of the mean
    float noise;      ///< of the first candidate: what the pixel's moments are relative to
    vec3 deviation;   ///< half of what it makes of the two halves differs by so much
    float unused;
};
SHARED_ROWS(DenoiseCandidate, 2);

/// What is summed over a window: products of changes, what each change takes of the error, and the error itself, all
/// relative to the radiance and to how large the pixel's error is expected to be.
struct DenoiseMoments {
    float product00, product01, product02, product11;
    float product12, product22, taken0, taken1;
    float taken2, error;
    float pixels; ///< 1; 0: unknown
    float spread; ///< the variance by the samples' own spread, relative to what the error is
};
SHARED_ROWS(DenoiseMoments, 3);

/// What becomes of a pixel. Squared errors are relative to the radiance, means of the channels, and in two parts: what e^2
/// is a factor of, in case the host knows more of it than the shaders, and the rest.
struct DenoiseResult {
    vec3 mean;
    float ownNoise; ///< of the pixel itself, by the shares that its neighbours choose
    vec3 shares; ///< of the candidates; the noisy picture has the rest
    float ownChange;
    float windowNoise, windowChange; ///< the window's
    float ownVariance; ///< that part of the pixel's error which is noise that is left
    float unused;
};
SHARED_ROWS(DenoiseResult, 3);

// --- The filter ----------------------------------------------------------------------------------

/// What albedo is at least where radiance is divided by it: black things need a bound, and what is below it may differ
/// by the layer's own noise.
SHARED_CONST float DENOISE_LEAST_ALBEDO = 0.05f;

/// How unlike surfaces may be, of the pilot and of the two candidates that are means: what a difference of albedo,
/// normals (of length 1) and depth (relative) is divided by, squared.
SHARED_CONST vec3 DENOISE_PILOT_SCALE = vec3(1.0f / (0.1f * 0.1f), 1.0f / (0.2f * 0.2f), 1.0f / (0.03f * 0.03f));
SHARED_CONST vec3 DENOISE_STRICT_SCALE = vec3(1.0f / (0.1f * 0.1f), 1.0f / (0.1f * 0.1f), 1.0f / (0.02f * 0.02f));
SHARED_CONST vec3 DENOISE_WIDE_SCALE = vec3(1.0f / (0.2f * 0.2f), 1.0f / (0.15f * 0.15f), 1.0f / (0.03f * 0.03f));
/// How unlike the radiance of pilots may be, in what their variances explain: a candidate that is strict, and two that
/// keep no more than the edges of lamps, which no layer shows.
SHARED_CONST float DENOISE_STRICT_COLOR = 1.0f / (1.25f * 1.25f);
SHARED_CONST float DENOISE_LOOSE_COLOR = 1.0f / (1.5f * 1.5f);

/// The regression: pixels to each side that it looks at; the exponent by which a neighbour counts less for its squared
/// distance (a deviation of 2 pixels); what a pixel's width is as a feature, beside albedo and normals of lengths up to 1;
/// and what is added to the features' own products, relative to the sum of the weights.
SHARED_CONST int DENOISE_REGRESSION_REACH = 3;
SHARED_CONST float DENOISE_REGRESSION_DISTANCE = 1.0f / (2.0f * 2.0f * 2.0f);
SHARED_CONST float DENOISE_REGRESSION_STEP = 0.1f;
SHARED_CONST float DENOISE_REGRESSION_RIDGE = 1e-5f;

/// Pixels to each side of the pilot's window, and of that over which moments are summed.
SHARED_CONST int DENOISE_PILOT_REACH = 2;
SHARED_CONST int DENOISE_WINDOW_REACH = 5;

/// What rounding leaves of a pixel's relative squared error: (2^-20)^2. Less noise than that is none.
SHARED_CONST float DENOISE_LEAST_NOISE = 1e-12f;

/// How often the shares of the candidates are improved one after the other.
SHARED_CONST int DENOISE_SWEEPS = 16;
/// How much less noise than its neighbours a pixel's own samples may say that it has, as a factor of its root: samples that
/// agree may all have missed the same light.
SHARED_CONST float DENOISE_LEAST_NOISINESS = 0.5f;
/// By how much products of a candidate with itself are made larger, so that a candidate that is hardly needed is left out.
SHARED_CONST float DENOISE_RIDGE = 0.1f;

/// A neighbour, and the exponents by which it counts less for its distance.
struct DenoiseTap {
    float dx, dy; ///< whole numbers of pixels
    float times;  ///< neighbours that it stands for
    float strict, wide; ///< the exponents of these candidates
    float unused0, unused1, unused2;
};
SHARED_ROWS(DenoiseTap, 2);

/// Push constants of one dispatch.
struct DenoiseDispatch {
    uint width, height; ///< of the picture
    uint topRow;        ///< of the picture, that buffers begin with
    uint firstRow, rowCount; ///< to be made
    uint tapCount;
    float floor; ///< radiance, squared, that is added to that which errors are compared with
};

SHARED_END

#endif
