// No ray passes between triangles of a closed mesh, neither in the triangle test nor in the
// traversal; a million rays at edges and corners, where they would.

#include "host/bvh/cpu_traversal.hpp"
#include "tests/bvh/fixtures.hpp"
#include "tests/bvh/oracle.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli::test {
namespace {

/// A corner, or a point of an edge, rounded.
glm::vec3 pointOnWireframe(const Scene& mesh, Random& random) {
    const Triangle& t = mesh.triangles[random.below(uint32_t(mesh.triangles.size()))];
    const uint32_t i = random.below(3);
    const glm::vec3 a = mesh.positions[t.corner[i]], b = mesh.positions[t.corner[(i + 1) % 3]];
    switch (random.below(3)) {
    case 0:
        return a;
    case 1:
        return 0.5f * (a + b);
    default:
        return a + random.uniform() * (b - a);
    }
}

/// Number of rays that leave the mesh unnoticed, from points inside: `origin` makes them.
template <class MakeOrigin>
uint32_t countEscapesFrom(const Traceable& t, MakeOrigin origin, int rays, Random& random) {
    uint32_t escapes = 0;
    for (int i = 0; i < rays; ++i) {
        TraversalRay ray;
        ray.origin = origin();
        ray.direction = pointOnWireframe(t.scene, random) - ray.origin;
        if (random.below(2)) ray.direction = glm::normalize(ray.direction);
        escapes += !anyHit(t.layout, ray);
        escapes += i % 8 == 0 && !closestHit(t.layout, ray);
    }
    return escapes;
}

uint32_t countEscapes(const Traceable& t, const glm::vec3& middle, float spread, int rays,
                      Random& random) {
    return countEscapesFrom(
        t, [&] { return middle + random.inCube(spread); }, rays, random);
}

uint32_t countEscapes(const Traceable& t, const glm::mat3& axes, float spread, int rays,
                      Random& random) {
    return countEscapesFrom(
        t, [&] { return axes * random.inCube(spread); }, rays, random);
}

TEST(Watertight, Star) {
    Random random(21);
    for (const uint32_t levels : {1u, 3u, 5u}) {
        const Traceable t(starMesh(levels, random));
        EXPECT_EQ(countEscapes(t, {0, 0, 0}, 0.1f, 150000, random), 0u) << levels;
    }
}

TEST(Watertight, StarFarFromTheOrigin) {
    // Embree's watertight_pos. Coordinates are multiples of 1/64 here: still a closed mesh
    // around its middle.
    const glm::vec3 far(148376, 1234, -223423);
    Random random(22);
    for (const uint32_t levels : {1u, 2u, 3u}) {
        Scene mesh = starMesh(levels, random);
        translate(mesh, far);
        const Traceable t(std::move(mesh));
        EXPECT_EQ(countEscapes(t, far, 0.1f, 100000, random), 0u) << levels;
    }
}

TEST(Watertight, CubeWhoseEdgesLieInBoxPlanes) {
    Random random(23);
    for (const uint32_t n : {1u, 7u, 16u}) {
        const Traceable t(cubeMesh(n));
        EXPECT_EQ(countEscapes(t, {0, 0, 0}, 0.9f, 100000, random), 0u) << n;
        Scene moved = cubeMesh(n);
        translate(moved, {0.3f, -1.7f, 100.1f});
        const Traceable m(std::move(moved));
        EXPECT_EQ(countEscapes(m, {0.3f, -1.7f, 100.1f}, 0.9f, 50000, random), 0u) << n;
    }
}

TEST(Watertight, AxisParallelRaysThroughGridCorners) {
    // Origins lie in the planes of boxes and two components of the direction are zero.
    constexpr int kSquares = 8;
    const Traceable t(cubeMesh(kSquares));
    for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {-1.0f, 1.0f})
            for (const float zero : {0.0f, -0.0f})
                for (int i = 1; i < 2 * kSquares; ++i)
                    for (int j = 1; j < 2 * kSquares; ++j) { // corners and middles of edges
                        TraversalRay ray;
                        ray.origin[axis] = 0.125f;
                        ray.origin[(axis + 1) % 3] = float(i) / kSquares - 1;
                        ray.origin[(axis + 2) % 3] = float(j) / kSquares - 1;
                        ray.direction = glm::vec3(zero);
                        ray.direction[axis] = sign;
                        const TraversalHit hit = closestHit(t.layout, ray);
                        EXPECT_EQ(hit.t, 1 - sign * 0.125f) << axis << ' ' << i << ' ' << j;
                    }
}

/// Needles: stretched by up to 2^-20 along two axes that are not the coordinate axes. Errors of the
/// triangle test along a needle are large against its width.
TEST(Watertight, ClosedMeshesOfNeedles) {
    Random random(26);
    for (int i = 0; i < 12; ++i) {
        Scene mesh = starMesh(1 + random.below(3), random);
        const glm::vec3 x = glm::normalize(random.vector());
        const glm::vec3 y = glm::normalize(glm::cross(x, random.vector()));
        const glm::mat3 axes(x, std::ldexp(1.0f, -int(random.below(20))) * y,
                             std::ldexp(1.0f, -int(random.below(20))) * glm::cross(x, y));
        for (glm::vec3& p : mesh.positions)
            p = axes * p;
        BuildOptions inParts;
        inParts.split = {20, 0, 0};
        const Traceable parts(mesh, inParts), t(std::move(mesh));
        EXPECT_EQ(countEscapes(t, axes, 0.2f, 20000, random), 0u) << i;
        EXPECT_EQ(countEscapes(parts, axes, 0.2f, 20000, random), 0u) << i << ", in parts";
    }
}

/// Rays from 1e7 away, along each axis, that in double precision pass through a triangle well
/// inside its edges. Along the axis the origin's distance to a corner is rounded to a whole unit,
/// which only blurs t; across it, float errors stay below 8 * 2^-24 of a unit or two.
TEST(Watertight, OriginFarAway) {
    constexpr double kMargin = 2e-6;
    Random random(24);
    const Traceable t(soup(2000, 0, 0.05f, random));
    uint32_t rays = 0, misses = 0;
    for (int i = 0; i < 100000; ++i) {
        const Triangle& triangle = t.scene.triangles[random.below(2000)];
        const glm::vec3 a = t.scene.positions[triangle.corner[0]];
        const glm::vec3 b = t.scene.positions[triangle.corner[1]];
        const glm::vec3 c = t.scene.positions[triangle.corner[2]];
        const float u = random.uniform(), v = random.uniform() * (1 - u);
        TraversalRay ray;
        ray.origin = random.inCube(1);
        ray.origin[int(random.below(3))] = random.below(2) ? 1e7f : -1e7f;
        ray.direction = a + u * (b - a) + v * (c - a) - ray.origin;
        if (random.below(2)) ray.direction *= 1e-7f;
        if (intersectInDouble(a, b, c, ray.origin, ray.direction).margin < kMargin) continue;
        ++rays;
        misses += !anyHit(t.layout, ray);
    }
    EXPECT_GT(rays, 50000u);
    EXPECT_EQ(misses, 0u);
}

} // namespace
} // namespace stromboli::test
