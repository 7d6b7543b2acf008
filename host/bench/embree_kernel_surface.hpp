#pragma once

#include "host/bench/embree_kernel_math.hpp"

namespace stromboli::bench::native {
namespace {

/// Where a path is, both normals on the side of wo.
struct Point {
    Vec position; ///< what light is reflected from: on the smooth surface
    Vec flat;     ///< the hit; what refracted light leaves from
    bool lifted;  ///< the smooth surface is above the flat one here
    float error;  ///< of the position, along the normal
    Vec geometric, shading;
    Vec wo;
    bool outside; ///< wo is on the side the stored geometric normal points to
    const Surface* surface;
};

struct Bounce {
    Vec direction;
    Vec weight; ///< f |cos| / pdf; 0: the path ends
};

inline bool isDelta(const Surface& s) {
    return s.kind != SurfaceKind::Diffuse;
}

inline Vec emission(const Point& p) {
    return p.outside || p.surface->emitsBothSides ? vec(p.surface->emission) : vec(0);
}

/// What the two ways of filling in a Point have in common.
inline void faceForward(Point& p) {
    p.outside = dot(p.geometric, p.wo) >= 0;
    if (!p.outside) p.geometric = -p.geometric;
    if (dot(p.shading, p.geometric) < 0) p.shading = -p.shading;
    if (dot(p.shading, p.wo) <= 0) p.shading = p.geometric;
}

/// The kernel has 32 u of the largest coordinate of a point that was interpolated from corners.
/// This one is on the ray, whose length adds to its error.
inline float pointError(Vec origin, float t) {
    return 64 * kRoundoff * (largest(absolute(origin)) + t);
}

template <bool hasNormals>
Point triangleAt(const World& world, const RTCRayHit& r, Vec origin, Vec direction) {
    Point p;
    p.position = origin + r.ray.tfar * direction;
    p.error = pointError(origin, r.ray.tfar);
    p.geometric = normalize(vec(r.hit.Ng_x, r.hit.Ng_y, r.hit.Ng_z));
    p.shading = p.geometric;
    p.wo = -direction;
    const TriangleShading& t = world.triangles[r.hit.primID];
    p.surface = world.surfaces + t.material;
    if (hasNormals && t.normal[0] != kNoNormals) {
        const auto normal = [&](int i) {
            Vec v;
            __builtin_memcpy(&v, world.normals + 4 * size_t(t.normal[i]), sizeof v);
            return v;
        };
        const Vec n =
            (1 - r.hit.u - r.hit.v) * normal(0) + r.hit.u * normal(1) + r.hit.v * normal(2);
        if (dot(n, n) > 0) p.shading = normalize(n);
    }
    faceForward(p);
    p.flat = p.position;
    p.lifted = false;
    if (hasNormals) {
        const float side = p.outside ? 1.0f : -1.0f;
        const float b[3] = {1 - r.hit.u - r.hit.v, r.hit.u, r.hit.v};
        float lift = 0;
        for (int i = 0; i < 3; ++i)
            lift += b[i] * b[(i + 1) % 3] * larger(side * t.bulge[i], 0.0f);
        p.lifted = lift > 0;
        p.position = p.flat + larger(lift, 0.0f) * p.geometric;
    }
    return p;
}

/// Where a ray starts that leaves p towards w, reflected or refracted.
inline Vec leave(const Point& p, Vec w) {
    const bool refracted = isDelta(*p.surface) && dot(p.geometric, w) < 0;
    if (refracted) return offset(p.flat, p.error, p.geometric, w);
    return offset(p.position, p.error, p.geometric, p.lifted ? p.geometric : w);
}

inline bool isReflected(const Point& p, Vec w) {
    return p.lifted || dot(p.geometric, w) > 0;
}

inline Point sphereAt(const World& world, const RTCRayHit& r, Vec origin, Vec direction) {
    const Sphere& s = world.spheres[r.hit.primID];
    const Vec center = vec(s.center);
    Point p;
    p.geometric = normalize(origin + r.ray.tfar * direction - center);
    p.position = center + s.radius * p.geometric;
    p.error = 64 * kRoundoff *
              (s.radius + largest(absolute(center)) + largest(absolute(origin)) + r.ray.tfar);
    p.shading = p.geometric;
    p.wo = -direction;
    p.surface = world.surfaces + s.material;
    p.flat = p.position;
    p.lifted = false;
    faceForward(p);
    return p;
}

/// f |cos| of a surface that is no delta distribution.
inline Vec evaluate(const Point& p, Vec wi) {
    const float cosine = dot(p.shading, wi);
    if (cosine <= 0 || !isReflected(p, wi)) return vec(0);
    return vec(p.surface->reflectance) * (cosine * (1 / kPi));
}

inline Bounce scatterDiffuse(const Point& p, Random2 u) {
    const float r = std::sqrt(u.x), z = std::sqrt(larger(1 - u.x, 0.0f));
    const SineCosine phi = turn(u.y);
    return {Frame(p.shading).toWorld(r * phi.cosine, r * phi.sine, z), vec(p.surface->reflectance)};
}

/// Refraction and glass; radiance is compressed by the square of the index ratio.
inline Bounce scatterDielectric(const Point& p, Random2 u) {
    const Surface& s = *p.surface;
    const float eta = p.outside ? 1 / s.ior : s.ior;
    const float cosine = smaller(dot(p.shading, p.wo), 1.0f);
    const float sin2 = eta * eta * larger(1 - cosine * cosine, 0.0f);
    const bool total = sin2 >= 1;
    const float transmitted = total ? 0 : std::sqrt(1 - sin2);
    float reflectance = 0;
    if (s.kind == SurfaceKind::Glass) {
        const float rs = (eta * cosine - transmitted) / (eta * cosine + transmitted);
        const float rp = (cosine - eta * transmitted) / (cosine + eta * transmitted);
        reflectance = total ? 1 : 0.5f * (rs * rs + rp * rp);
    }
    if (u.x < reflectance) return {2 * cosine * p.shading - p.wo, vec(s.reflectance)};
    return {(eta * cosine - transmitted) * p.shading - eta * p.wo,
            total ? vec(0) : vec(s.transmittance) * (eta * eta)};
}

template <bool hasDelta>
Bounce scatter(const Point& p, Random2 u) {
    Bounce b;
    bool transmitted = false;
    if (!hasDelta || p.surface->kind == SurfaceKind::Diffuse) {
        b = scatterDiffuse(p, u);
    } else if (p.surface->kind == SurfaceKind::Mirror) {
        b = {2 * dot(p.shading, p.wo) * p.shading - p.wo, vec(p.surface->reflectance)};
    } else {
        b = scatterDielectric(p, u);
        transmitted = dot(b.direction, p.shading) < 0;
    }
    // Light stays on the side of the true surface that it was sent to.
    if (transmitted ? dot(p.geometric, b.direction) >= 0 : !isReflected(p, b.direction))
        b.weight = vec(0);
    return b;
}

} // namespace
} // namespace stromboli::bench::native
