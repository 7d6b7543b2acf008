#pragma once

#include "host/bench/embree_kernel_math.hpp"

// The kernel's random numbers, bit for bit: shaders/include/random.glsl and sobol.glsl, where the
// sources are.
namespace stromboli::bench::native {
namespace {

struct Words4 {
    uint32_t x, y, z, w;
};

/// pcg4d (Jarzynski and Olano 2020).
inline Words4 hashed(Words4 v) {
    const auto lcg = [](uint32_t u) { return u * 1664525u + 1013904223u; };
    uint32_t x = lcg(v.x), y = lcg(v.y), z = lcg(v.z), w = lcg(v.w);
    const auto mix = [&] {
        x += y * w;
        y += z * x;
        z += x * y;
        w += y * z;
    };
    mix();
    x ^= x >> 16;
    y ^= y >> 16;
    z ^= z >> 16;
    w ^= w >> 16;
    mix();
    return {x, y, z, w};
}

inline Random unitFloats(Words4 v) {
    const auto unit = [](uint32_t u) { return float(int(u)) * 0x1p-24f; };
    const uint32_t leftOver = (v.x & 0xFF) | (v.y & 0xFF) << 8 | (v.z & 0xFF) << 16;
    return {unit(v.x >> 8), unit(v.y >> 8), unit(v.z >> 8), unit(v.w >> 8), unit(leftOver)};
}

/// Independent numbers in [0, 1).
inline Random randomBlock(uint32_t pixel, uint32_t sample, uint32_t block, uint32_t seed) {
    return unitFloats(hashed({pixel, sample, block, seed}));
}

inline uint32_t reversedBits(uint32_t x) {
    x = __builtin_bswap32(x);
    x = (x & 0x0F0F0F0Fu) << 4 | (x >> 4 & 0x0F0F0F0Fu);
    x = (x & 0x33333333u) << 2 | (x >> 2 & 0x33333333u);
    return (x & 0x55555555u) << 1 | (x >> 1 & 0x55555555u);
}

inline uint32_t scrambleReversed(uint32_t x, uint32_t key) {
    x ^= x * 0x3D20ADEAu;
    x += key;
    x *= key >> 16 | 1;
    x ^= x * 0x05526C56u;
    return x ^ (x * 0x53A22864u);
}

inline uint32_t sobolReversed1(uint32_t y) {
    y ^= y >> 16;
    y ^= (y & 0xFF00FF00u) >> 8;
    y ^= (y & 0xF0F0F0F0u) >> 4;
    y ^= (y & 0xCCCCCCCCu) >> 2;
    return y ^ (y & 0xAAAAAAAAu) >> 1;
}

inline uint32_t sobolReversed2(uint32_t y) {
    y ^= (y & 0xFF0000u) >> 8 ^ y >> 16;
    y ^= (y & 0xF00u) >> 4 ^ (y & 0xF00u) >> 8 ^ (y & 0xF000u) >> 12;
    y ^= (y & 0x303030u) >> 2 ^ (y & 0x30C030u) >> 4 ^ (y & 0xC0C0C0u) >> 6;
    y ^= (y & 0x444444u) >> 1 ^ (y & 0x848484u) >> 2 ^ (y & 0x888888u) >> 3;
    return y ^ (y & 0x222222u) >> 1;
}

inline uint32_t sobolReversed3(uint32_t y) {
    y ^= (y & 0x0FF000u) >> 8 ^ (y & 0xFFF000u) >> 12 ^ (y & 0xF00000u) >> 16 ^ y >> 20;
    y ^= (y & 0x3C03C0u) >> 4 ^ (y & 0xFC0FC0u) >> 6 ^ (y & 0x300C00u) >> 8 ^ (y & 0xC00C00u) >> 10;
    y ^= (y & 0x618618u) >> 2 ^ (y & 0xE38E38u) >> 3 ^ (y & 0x420420u) >> 4 ^ (y & 0x820820u) >> 5;
    return y ^ (y & 0x492492u) >> 1 ^ (y & 0x820820u) >> 2;
}

/// A point of a shuffled and scrambled Sobol sequence.
inline Random sobolBlock(uint32_t pixel, uint32_t sample, uint32_t block, uint32_t seed) {
    const Words4 key = hashed({pixel, sample >> 24, block, seed});
    const uint32_t index =
        reversedBits(scrambleReversed(reversedBits(sample), key.x + key.z)) & 0xFFFFFFu;
    return unitFloats({reversedBits(scrambleReversed(index, key.x)),
                       reversedBits(scrambleReversed(sobolReversed1(index), key.y)),
                       reversedBits(scrambleReversed(sobolReversed2(index), key.z)),
                       reversedBits(scrambleReversed(sobolReversed3(index), key.w))});
}

} // namespace
} // namespace stromboli::bench::native
