#pragma once

#include "host/bench/embree_kernel_light_tree.hpp"
#include "host/bench/embree_kernel_spherical.hpp"
#include "host/bench/embree_kernel_surface.hpp"

namespace stromboli::bench::native {
namespace {

/// A sampled way to a light (docs/estimator.md has the densities).
struct LightSample {
    Vec direction; ///< unit
    Vec radiance;  ///< over the density; 0: nothing arrives
    Vec target;    ///< finite lights: just before the emitter
    bool infinite;
};

inline bool isLit(Vec v) {
    return v[0] + v[1] + v[2] > 0;
}

/// Bound of the error of a point on an emitter seen from `from`: its own, and that of the segment.
inline float emitterError(Vec emitter, Vec from) {
    return 64 * kRoundoff * (largest(absolute(emitter)) + largest(absolute(from)));
}

/// Completes a sample taken uniformly on an area.
inline LightSample areaSample(const Point& p, const Light& light, float area, Vec at, Vec normal) {
    const Vec to = at - p.position;
    const float distance2 = dot(to, to);
    LightSample s;
    s.infinite = false;
    s.direction = to * (1 / std::sqrt(distance2));
    s.target = offset(at, emitterError(at, p.position), normal, -to);
    const float cosine = -dot(s.direction, normal);
    const bool emits = light.bothSides ? cosine != 0 : cosine > 0;
    s.radiance =
        emits && distance2 > 0 ? vec(light.color) * (area * std::fabs(cosine) / distance2) : vec(0);
    return s;
}

/// Completes a sample taken uniformly by direction. z: distance of the emitter's plane on the side
/// that `normal` points from.
inline LightSample angleSample(const Point& p, Vec emission, bool bothSides, Vec at, Vec normal,
                               float z, float angle) {
    const Vec to = at - p.position;
    const float distance2 = dot(to, to), error = emitterError(at, p.position);
    LightSample s;
    s.infinite = false;
    s.direction = to * (1 / std::sqrt(larger(distance2, kTiny)));
    s.target = offset(at, error, normal, -to);
    const bool apart = std::fabs(z) > p.error + error && distance2 > 0;
    const bool emits = apart && (bothSides || z < 0);
    s.radiance = emits ? emission * angle : vec(0);
    return s;
}

inline LightSample sampleQuad(const Point& p, const Light& light, Random2 u) {
    const Vec corner = vec(light.position), a = vec(light.edgeA), b = vec(light.edgeB),
              normal = vec(light.normal);
    const Vec v0 = corner - p.position;
    const float z = dot(v0, normal);
    const SolidAngleSample s = sampleQuadByAngle(v0, a, b, z, light.area, u.x, u.y);
    return angleSample(p, vec(light.color), light.bothSides,
                       corner + s.weights.a * a + s.weights.b * b, normal, z, s.angle);
}

inline LightSample sampleTriangle(const Point& p, const TriangleLight& t, Random2 u) {
    const Vec corner = vec(t.corner), a = vec(t.edgeA), b = vec(t.edgeB), normal = vec(t.normal);
    const Vec v0 = corner - p.position;
    const float z = dot(v0, normal);
    const SolidAngleSample s = sampleTriangleByAngle(v0, a, b, z, t.doubleArea, u.x, u.y);
    return angleSample(p, vec(t.emission), t.bothSides, corner + s.weights.a * a + s.weights.b * b,
                       normal, z, s.angle);
}

inline LightSample sampleSphere(const Point& p, const Light& light, Random2 u) {
    const Vec center = vec(light.position);
    const Vec from = offset(p.position, p.error, p.geometric, p.wo);
    const Vec toCenter = center - from;
    const float distance2 = dot(toCenter, toCenter), radius = light.radius;
    const float sin2Max = radius * radius / distance2;
    const SineCosine phi = turn(u.y);
    if (!(sin2Max < 1)) {
        const float z = 1 - 2 * u.x, r = 2 * std::sqrt(u.x * (1 - u.x));
        const Vec n = vec(r * phi.cosine, r * phi.sine, z);
        return areaSample(p, light, 4 * kPi * radius * radius, center + radius * n, n);
    }
    const float oneMinusCosMax = sin2Max / (1 + std::sqrt(1 - sin2Max));
    const float oneMinusCos = u.x * oneMinusCosMax, cosine = 1 - oneMinusCos;
    const float sin2 = oneMinusCos * (2 - oneMinusCos), sine = std::sqrt(sin2);
    const float distance = std::sqrt(distance2);
    LightSample s;
    s.direction =
        Frame(toCenter * (1 / distance)).toWorld(sine * phi.cosine, sine * phi.sine, cosine);
    const float t = distance * cosine - std::sqrt(larger(radius * radius - distance2 * sin2, 0.0f));
    const Vec n = normalize(from + t * s.direction - center);
    const Vec at = center + radius * n;
    s.target = offset(at, emitterError(at, p.position), n, p.position - at);
    s.infinite = false;
    s.radiance = vec(light.color) * (2 * kPi * oneMinusCosMax);
    return s;
}

inline Vec ambientRadianceOf(const Light& light, Vec direction) {
    return direction[1] > 0 ? vec(light.color) + vec(light.fromAbove) : vec(light.color);
}

inline LightSample sampleAmbient(const Point& p, const Light& light, Random2 u) {
    const float r = std::sqrt(u.x), z = std::sqrt(larger(1 - u.x, 0.0f));
    const SineCosine phi = turn(u.y);
    LightSample s;
    s.direction = Frame(p.shading).toWorld(r * phi.cosine, r * phi.sine, z);
    s.infinite = true;
    s.target = s.direction;
    s.radiance = ambientRadianceOf(light, s.direction) * (kPi / larger(z, kTiny));
    return s;
}

/// The share of the way to a point light, at its end, where nothing shades (docs/estimator.md).
constexpr float kPointLightGap = 0x1p-16f;

inline LightSample sampleDelta(const Point& p, const Light& light) {
    const Vec position = vec(light.position);
    if (light.kind == gpu::LIGHT_DIRECTIONAL) return {position, vec(light.color), position, true};
    const Vec to = position - p.position;
    const float distance2 = dot(to, to), distance = std::sqrt(distance2);
    const float attenuation =
        light.attenuation[0] + light.attenuation[1] * distance + light.attenuation[2] * distance2;
    LightSample s{to * (1 / distance), vec(light.color) * (1 / attenuation),
                  position - kPointLightGap * to, false};
    if (!(distance2 > 0)) s.radiance = vec(0);
    if (light.kind == gpu::LIGHT_SPOT) {
        const float cosine = -dot(s.direction, vec(light.axis));
        const float edge =
            1 - larger(1 - larger((cosine - light.cosCutoff) * light.softness, 0.0f), 0.0f);
        const float power =
            light.falloffExponent == 0 ? 1 : std::pow(larger(cosine, 0.0f), light.falloffExponent);
        const float falloff = light.softness > 0 ? edge * edge : power;
        s.radiance = cosine >= light.cosCutoff ? s.radiance * falloff : vec(0);
    }
    return s;
}

template <bool otherLights>
LightSample sampleLight(const World& w, const Point& p, const LightEntry& entry, Random2 u) {
    if (!otherLights) return sampleQuad(p, w.lights[0], u);
    if (entry.isTriangle) return sampleTriangle(p, w.triangleLights[entry.index], u);
    const Light& light = w.lights[entry.index];
    switch (light.kind) {
    case gpu::LIGHT_QUAD:
        return sampleQuad(p, light, u);
    case gpu::LIGHT_SPHERE:
        return sampleSphere(p, light, u);
    case gpu::LIGHT_AMBIENT:
        return sampleAmbient(p, light, u);
    default:
        return sampleDelta(p, light);
    }
}

/// What ambient light sends to a ray that hits nothing.
inline Vec ambientRadiance(const World& w, Vec direction) {
    return w.hasAmbient ? ambientRadianceOf(w.lights[0], direction) : vec(0);
}

} // namespace
} // namespace stromboli::bench::native
