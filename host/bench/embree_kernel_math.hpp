#pragma once

#include "host/bench/embree_kernel.hpp"

#include <cmath>
#include <cstdint>
#include <limits>

// Only for the files of embree_kernel.cpp: everything is internal to them, see there.
namespace stromboli::bench::native {
namespace {

constexpr float kPi = 3.14159265358979f;
constexpr float kRoundoff = 0x1p-24f; ///< unit round-off of float
constexpr float kLargestFloat = 3.402823466e38f;

// One instruction each, where std::fmax is a call that minds NaN.
inline float larger(float a, float b) {
    return a > b ? a : b;
}
inline float smaller(float a, float b) {
    return a < b ? a : b;
}

/// Three floats in one register; the fourth lane is not looked at.
struct Vec {
    using Lanes = float __attribute__((vector_size(16)));
    Lanes v;

    float operator[](int i) const { return v[i]; }
};

inline Vec vec(float x, float y, float z) {
    return {Vec::Lanes{x, y, z, 0}};
}
inline Vec vec(const Vec3& a) {
    return vec(a.x, a.y, a.z);
}
inline Vec vec(float x) {
    return {Vec::Lanes{x, x, x, x}};
}
inline Vec operator+(Vec a, Vec b) {
    return {a.v + b.v};
}
inline Vec operator-(Vec a, Vec b) {
    return {a.v - b.v};
}
inline Vec operator*(Vec a, Vec b) {
    return {a.v * b.v};
}
inline Vec operator*(Vec a, float b) {
    return {a.v * b};
}
inline Vec operator*(float a, Vec b) {
    return {a * b.v};
}
inline Vec operator-(Vec a) {
    return {-a.v};
}

inline float dot(Vec a, Vec b) {
    const Vec p = a * b;
    return p[0] + p[1] + p[2];
}
inline Vec cross(Vec a, Vec b) {
    using Index = int __attribute__((vector_size(16)));
    constexpr Index yzx{1, 2, 0, 3};
    const Vec::Lanes c = a.v * __builtin_shuffle(b.v, yzx) - __builtin_shuffle(a.v, yzx) * b.v;
    return {__builtin_shuffle(c, yzx)};
}
inline float largest(Vec a) {
    return larger(a[0], larger(a[1], a[2]));
}
inline Vec absolute(Vec a) {
    using Bits = int __attribute__((vector_size(16)));
    constexpr int k = 0x7FFFFFFF;
    return {reinterpret_cast<Vec::Lanes>(reinterpret_cast<Bits>(a.v) & Bits{k, k, k, k})};
}
inline Vec normalize(Vec a) {
    return a * (1 / std::sqrt(dot(a, a)));
}

struct Frame {
    Vec x, y, z;
    /// About unit n (Duff et al. 2017).
    explicit Frame(Vec n) : z(n) {
        const float s = n[2] >= 0 ? 1.0f : -1.0f; // zeros of both signs alike
        const float a = -1 / (s + n[2]), b = n[0] * n[1] * a;
        x = vec(1 + s * n[0] * n[0] * a, s * b, -s * n[0]);
        y = vec(b, s + n[1] * n[1] * a, -n[1]);
    }
    Vec toWorld(float a, float b, float c) const { return a * x + b * y + c * z; }
};

struct SineCosine {
    float sine, cosine;
};

/// Of 2 pi u, u in [0, 1): to the nearest quarter turn and Cephes' polynomials on [-pi/4, pi/4].
inline SineCosine turn(float u) {
    const float quarters = std::nearbyint(4 * u);
    const float x = (4 * u - quarters) * (kPi / 2), x2 = x * x;
    const float s =
        x + x * x2 * (-1.6666654611e-1f + x2 * (8.3321608736e-3f - x2 * 1.9515295891e-4f));
    const float c =
        1 - 0.5f * x2 +
        x2 * x2 *
            (4.166664568298827e-2f + x2 * (-1.388731625493765e-3f + x2 * 2.443315711809948e-5f));
    const auto quadrant = int(quarters);
    const bool swapped = quadrant & 1;
    const float sine = swapped ? c : s, cosine = swapped ? s : c;
    return {quadrant & 2 ? -sine : sine, (quadrant + 1) & 2 ? -cosine : cosine};
}

struct Random2 {
    float x, y;
};

/// A block of random numbers: four, and a fifth of their last digits.
struct Random {
    float x, y, z, w, leftOver;
};

/// Moves p, whose error is at most `error`, along the unit normal n to the side of w.
inline Vec offset(Vec p, float error, Vec n, Vec w) {
    return p + std::copysign(error, dot(n, w)) * n;
}

} // namespace
} // namespace stromboli::bench::native
