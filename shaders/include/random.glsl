// Counter-based random numbers: a pure function of pixel, sample, dimension block and seed, so
// that no order of work changes a picture.

/// Jarzynski and Olano, "Hash Functions for GPU Rendering" (JCGT 2020): pcg4d.
uvec4 pcg4d(uvec4 v) {
    v = v * 1664525u + 1013904223u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    v ^= v >> 16u;
    v.x += v.y * v.w;
    v.y += v.z * v.x;
    v.z += v.x * v.y;
    v.w += v.y * v.z;
    return v;
}

/// Uniform in [0, 1 - 2^-24]: the top 24 bits, so that 1 never comes out by rounding.
/// Converted as signed integers (docs/theory/kernel.md, "Arithmetic").
vec4 unitFloats(uvec4 words) { return vec4(ivec4(words >> 8u)) * (1.0 / 16777216.0); }

#include "sobol.glsl"

/// Four words, each uniform. A block is a use of randomness within a sample (path.glsl). Blocks are
/// independent of each other, and so are pixels; the samples of a block are either independent too or
/// spread evenly.
uvec4 randomWords(uint pixel, uint sampleIndex, uint block, uint seed) {
    if (SAMPLER == SAMPLER_SOBOL) return sobolWords(pixel, sampleIndex, block, seed);
    return pcg4d(uvec4(pixel, sampleIndex, block, seed));
}

/// Who draws which blocks of a sample. From 0 on they are those of path rays (pathWords()), and media and choices have one
/// for each bounce beside them.
const uint MEDIUM_BLOCKS = 0x20000000u; ///< | bounce
const uint CHOICE_BLOCKS = 0x40000000u; ///< | bounce, from 1 on: choices between reflection and transmission
const uint LENS_BLOCK = 0x40000000u; ///< of the camera, before any bounce
const uint STOPPING_BLOCK = 0x7FFFFFFFu; ///< decides on stopping; no sample uses it
const uint BRANCH_BLOCKS = 0x80000000u; ///< a bit beside all of these, of branches: no path has it before it splits

/// Four numbers in [0, 1).
vec4 randomBlock(uint pixel, uint sampleIndex, uint block, uint seed) {
    return unitFloats(randomWords(pixel, sampleIndex, block, seed));
}

/// A fifth number in [0, 1), of the 24 digits that unitFloats leaves of the first three words. Scrambled
/// digits do not depend on those before them.
float leftOver(uvec4 words) {
    const uvec3 low = words.xyz & 0xFFu;
    return float(int(low.x | low.y << 8u | low.z << 16u)) * (1.0 / 16777216.0);
}
