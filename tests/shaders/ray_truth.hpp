#pragma once

#include "tests/bvh/oracle.hpp"
#include "tests/shaders/placed.hpp"
#include "tests/shaders/queries.h"

#include <cmath>
#include <utility>
#include <vector>

namespace stromboli::test {

/// A primitive's hits along a ray in double precision, t ascending.
struct Crossing {
    double t = 0;
    /// How far within the primitive's outline the ray passes; rays nearer to it than the
    /// rounding of coordinates may count either way.
    double margin = -1;
};

inline std::vector<Crossing> crossings(const Placed& p, const gpu::RayQuery& q) {
    if (!p.isSphere) {
        const TriangleTruth hit = intersectInDouble(p.v0, p.v1, p.v2, q.origin, q.direction);
        return {{hit.t, hit.margin}};
    }
    const glm::dvec3 d(q.direction), f = glm::dvec3(q.origin) - glm::dvec3(p.v0);
    const double length = glm::length(d), closest = -glm::dot(f, d) / (length * length);
    const double r = p.radius, across = glm::length(glm::cross(f, d)) / length;
    const double half = std::sqrt(std::max(r * r - across * across, 0.0)) / length;
    return {{closest - half, r - across}, {closest + half, r - across}};
}

/// In units of length: coordinates are below 8 and carry some 20 roundings; t of triangles seen
/// at a slant and of spheres near their outline is worse by the slope.
inline constexpr double kAcross = 8 * 20 * 0x1p-24;

/// What may be said of a ray with certainty.
struct Expectation {
    double latest = INFINITY;                          ///< a hit at or before this t is certain
    std::vector<std::pair<uint32_t, double>> possible; ///< place, t
};

inline Expectation expect(const std::vector<Placed>& primitives, const gpu::RayQuery& q,
                          double tolerance) {
    Expectation e;
    for (const Placed& p : primitives) {
        if (p.place == q.skipPrimitive && !p.isSphere) continue;
        for (const Crossing& c : crossings(p, q)) {
            const bool within = c.t > q.tMin - tolerance && c.t < double(q.tMax) + tolerance;
            if (!within || c.margin < -kAcross) continue;
            e.possible.emplace_back(p.place, c.t);
            const bool surely = c.t > q.tMin + tolerance && c.t < double(q.tMax) - tolerance;
            if (surely && c.margin > kAcross) e.latest = std::min(e.latest, c.t);
        }
    }
    return e;
}

} // namespace stromboli::test
