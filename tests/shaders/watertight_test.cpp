// No ray passes between triangles of a closed mesh on the device: neither hitTrianglePair, tried on
// every triangle, nor the traversal lets one out. Half a million rays at edges and corners each.
#include "tests/bvh/fixtures.hpp"
#include "tests/shaders/placed.hpp"
#include "tests/shaders/queries.h"
#include "tests/support/device_fixture.hpp"
#include "tests/support/test_shader.hpp"

#include "embedded/trace_texel.h"

#include <gtest/gtest.h>

namespace stromboli::test {
namespace {

using gpu::RayAnswer;
using gpu::RayQuery;

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

struct Escapes {
    uint32_t brute = 0, traversal = 0, naive = 0;
};

class Watertight : public DeviceTest {
  protected:
    /// Rays from within `spread` of `middle`, all inside the closed mesh.
    Escapes countEscapes(Scene mesh, const glm::vec3& middle, float spread, uint32_t rays,
                         Random& random) {
        const GpuScene scene = pack(mesh);
        shader_.setScene(scene);
        std::vector<RayQuery> queries(rays);
        for (uint32_t i = 0; i < rays; ++i) {
            RayQuery& q = queries[i];
            q.origin = middle + random.inCube(spread);
            q.direction = pointOnWireframe(mesh, random) - q.origin;
            if (i & 1) q.direction = glm::normalize(q.direction);
            q.tMax = kInfinite;
            q.skipPrimitive = gpu::NO_PRIMITIVE;
            q.anyHit = i % 4 < 2;
        }
        gpu::Dispatch constants{};
        constants.segmentBase = uint32_t(scene.bvh.records.size());
        constants.hardIterations = 1000;
        Escapes escapes;
        for (const RayAnswer& a : ask<RayAnswer>(shader_, queries, constants)) {
            escapes.brute += a.bruteHits == 0;
            escapes.traversal += a.primitive == gpu::NO_PRIMITIVE;
            escapes.naive += a.naiveHits == 0;
        }
        return escapes;
    }

    TestShader shader_{trace_texel, ShaderOptions::texel()};
};

TEST_F(Watertight, Star) {
    Random random(61);
    uint32_t naive = 0;
    for (const uint32_t levels : {0u, 1u, 2u}) {
        const Escapes e = countEscapes(starMesh(levels, random), {0, 0, 0}, 0.1f, 170000, random);
        EXPECT_EQ(e.brute, 0u) << levels;
        EXPECT_EQ(e.traversal, 0u) << levels;
        naive += e.naive;
    }
    EXPECT_GT(naive, 10u) << "negative control: Moeller-Trumbore is not watertight";
}

TEST_F(Watertight, StarFarFromTheOrigin) {
    const glm::vec3 far(148376, 1234, -223423); // Embree's watertight_pos
    Random random(62);
    for (const uint32_t levels : {0u, 1u, 2u}) {
        Scene mesh = starMesh(levels, random);
        translate(mesh, far);
        const Escapes e = countEscapes(std::move(mesh), far, 0.1f, 170000, random);
        EXPECT_EQ(e.brute, 0u) << levels;
        EXPECT_EQ(e.traversal, 0u) << levels;
    }
}

TEST_F(Watertight, CubeWhoseEdgesLieInBoxPlanes) {
    Random random(63);
    for (const uint32_t n : {1u, 3u}) {
        const Escapes e = countEscapes(cubeMesh(n), {0, 0, 0}, 0.9f, 100000, random);
        EXPECT_EQ(e.brute, 0u) << n;
        EXPECT_EQ(e.traversal, 0u) << n;
    }
}

/// NUMERICS 4 and 22: origins in the planes of boxes, two components of the direction zero.
TEST_F(Watertight, AxisParallelRaysThroughGridCorners) {
    constexpr int kSquares = 4;
    Scene mesh = cubeMesh(kSquares);
    shader_.setScene(pack(mesh));
    std::vector<RayQuery> queries;
    for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {-1.0f, 1.0f})
            for (const float zero : {0.0f, -0.0f})
                for (int i = 1; i < 2 * kSquares; ++i)
                    for (int j = 1; j < 2 * kSquares; ++j) { // corners and middles of edges
                        RayQuery q{};
                        q.origin[axis] = 0.125f;
                        q.origin[(axis + 1) % 3] = float(i) / kSquares - 1;
                        q.origin[(axis + 2) % 3] = float(j) / kSquares - 1;
                        q.direction = glm::vec3(zero);
                        q.direction[axis] = sign;
                        q.tMax = kInfinite;
                        q.skipPrimitive = gpu::NO_PRIMITIVE;
                        queries.push_back(q);
                    }
    gpu::Dispatch constants{};
    constants.hardIterations = 1000;
    const std::vector<RayAnswer> found = ask<RayAnswer>(shader_, queries, constants);
    for (size_t i = 0; i < queries.size(); ++i) {
        const glm::vec3& d = queries[i].direction;
        EXPECT_EQ(found[i].t, 1 - (d.x + d.y + d.z) * 0.125f) << i;
    }
}

} // namespace
} // namespace stromboli::test
