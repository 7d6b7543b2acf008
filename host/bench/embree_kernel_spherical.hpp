#pragma once

#include "host/bench/embree_kernel_math.hpp"

// Triangles and parallelograms sampled by solid angle: shaders/include/spherical.glsl, where the
// sources and reasons are.
namespace stromboli::bench::native {
namespace {

constexpr float kTiny = 0x1p-120f;

/// Angle in [0, pi] of the point (x, y), y >= 0.
inline float angleOf(float y, float x) {
    const float ax = std::fabs(x), q = smaller(ax, y) / larger(larger(ax, y), kTiny), q2 = q * q;
    const float p =
        -0.3333314528f +
        q2 *
            (0.1999355085f +
             q2 * (-0.1420889944f +
                   q2 * (0.1065626393f + q2 * (-0.0752896400f +
                                               q2 * (0.0429096138f + q2 * (-0.0161657367f +
                                                                           q2 * 0.0028662257f))))));
    const float small = q + q * q2 * p, angle = y > ax ? 0.5f * kPi - small : small;
    return x < 0 ? kPi - angle : angle;
}

struct SeenCorner {
    Vec direction; ///< unit
    float distance;
};

inline SeenCorner see(Vec toCorner) {
    const float distance = std::sqrt(larger(dot(toCorner, toCorner), kTiny));
    return {toCorner * (1 / distance), distance};
}

struct SeenTriangle {
    SeenCorner pivot, start, end;
    float volume;
};

inline SeenTriangle seeTriangle(const SeenCorner& pivot, const SeenCorner& start,
                                const SeenCorner& end, float z, float doubleArea) {
    return {pivot, start, end,
            std::fabs(z) / pivot.distance * (doubleArea / start.distance / end.distance)};
}

inline float solidAngle(const SeenTriangle& t) {
    return 2 * angleOf(t.volume, 1 + dot(t.pivot.direction, t.start.direction) +
                                     dot(t.start.direction, t.end.direction) +
                                     dot(t.pivot.direction, t.end.direction));
}

inline float halfChord2(Vec a, Vec b) {
    return 0.25f * dot(a - b, a - b);
}

inline float unitShare(float part, float rest) {
    return smaller(larger(part / larger(part + rest, kTiny), 0.0f), 1.0f);
}

/// Weights of an emitter's edges from its first corner.
struct EdgeWeights {
    float a, b;
};

inline EdgeWeights sampleSeenTriangle(const SeenTriangle& t, float angle, float v) {
    const SineCosine half = turn(angle * (1 / (4 * kPi)));
    const float startPivot = dot(t.start.direction, t.pivot.direction);
    const float endPivot = dot(t.end.direction, t.pivot.direction);
    const float edge2 = halfChord2(t.start.direction, t.end.direction);
    const float cosEdge = 1 - 2 * edge2, sin2Edge = 4 * edge2 * (1 - edge2);
    const float tangent =
        half.sine * (1 + startPivot) /
        larger(half.cosine * t.volume - half.sine * (endPivot - startPivot * cosEdge), kTiny);
    const float along =
        unitShare(2 * tangent * t.start.distance,
                  t.end.distance * (1 - tangent * tangent * sin2Edge - 2 * tangent * cosEdge));
    const Vec from = t.start.direction * t.start.distance, to = t.end.direction * t.end.distance;
    const SeenCorner swung = see(from + along * (to - from));
    const float arc2 = halfChord2(t.pivot.direction, swung.direction);
    const float sine = std::sqrt(v * (1 - v * arc2));
    const float rest = std::sqrt(1 - arc2) * (1 - 2 * v * arc2) - (1 - 2 * arc2) * sine;
    const float out = unitShare(sine * t.pivot.distance, swung.distance * rest);
    return {out * (1 - along), out * along};
}

/// A point chosen uniformly by direction, and the steradians that the emitter takes up.
struct SolidAngleSample {
    EdgeWeights weights;
    float angle;
};

inline SolidAngleSample sampleTriangleByAngle(Vec v0, Vec a, Vec b, float z, float doubleArea,
                                              float u, float v) {
    const SeenTriangle t = seeTriangle(see(v0), see(v0 + a), see(v0 + b), z, doubleArea);
    const float angle = solidAngle(t);
    return {sampleSeenTriangle(t, u * angle, v), angle};
}

inline SolidAngleSample sampleQuadByAngle(Vec v0, Vec a, Vec b, float z, float area, float u,
                                          float v) {
    const SeenCorner pivot = see(v0), far = see(v0 + a + b);
    const SeenTriangle first = seeTriangle(pivot, see(v0 + a), far, z, area),
                       second = seeTriangle(pivot, far, see(v0 + b), z, area);
    const float ofFirst = solidAngle(first), angle = ofFirst + solidAngle(second);
    const float swept = u * angle;
    if (swept < ofFirst) {
        const EdgeWeights w = sampleSeenTriangle(first, swept, v);
        return {{w.a + w.b, w.b}, angle};
    }
    const EdgeWeights w = sampleSeenTriangle(second, swept - ofFirst, v);
    return {{w.a, w.a + w.b}, angle};
}

} // namespace
} // namespace stromboli::bench::native
