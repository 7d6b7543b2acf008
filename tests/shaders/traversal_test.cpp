// The traversal on the device against trying every primitive in double precision.
#include "host/bvh/primitive_bounds.hpp"
#include "host/kernel/gpu_scene.hpp"
#include "tests/bvh/fixtures.hpp"
#include "tests/bvh/oracle.hpp"
#include "tests/shaders/queries.h"
#include "tests/support/device_fixture.hpp"
#include "tests/support/test_shader.hpp"

#include "embedded/trace_storage.h"
#include "embedded/trace_texel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace stromboli::test {
namespace {

using gpu::RayAnswer;
using gpu::RayQuery;

constexpr float kInfinite = 3.402823466e38f;
constexpr uint32_t kStepLimit = 20000;

/// A primitive's hits along a ray in double precision, t ascending.
struct Crossing {
    double t = 0;
    /// How far within the primitive's outline the ray passes; rays nearer to it than the
    /// rounding of coordinates may count either way.
    double margin = -1;
};

std::vector<Crossing> crossings(const gpu::Primitive& p, const RayQuery& q) {
    if (p.kind == gpu::PRIMITIVE_TRIANGLE) {
        const TriangleTruth hit = intersectInDouble(p.v0, p.v1, p.v2, q.origin, q.direction);
        return {{hit.t, hit.margin}};
    }
    const glm::dvec3 d(q.direction), f = glm::dvec3(q.origin) - glm::dvec3(p.v0);
    const double length = glm::length(d), closest = -glm::dot(f, d) / (length * length);
    const double r = p.v1.x, across = glm::length(glm::cross(f, d)) / length;
    const double half = std::sqrt(std::max(r * r - across * across, 0.0)) / length;
    return {{closest - half, r - across}, {closest + half, r - across}};
}

/// In units of length: coordinates are below 8 and carry some 20 roundings; t of triangles seen
/// at a slant and of spheres near their outline is worse by the slope.
constexpr double kAcross = 8 * 20 * 0x1p-24;

/// What may be said of a ray with certainty.
struct Expectation {
    double latest = INFINITY;                          ///< a hit at or before this t is certain
    std::vector<std::pair<uint32_t, double>> possible; ///< primitive, t
};

Expectation expect(const GpuScene& scene, const RayQuery& q, double tolerance) {
    Expectation e;
    for (uint32_t i = 0; i < scene.primitives.size(); ++i) {
        const gpu::Primitive& p = scene.primitives[i];
        if (i == q.skipPrimitive && p.kind == gpu::PRIMITIVE_TRIANGLE) continue;
        for (const Crossing& c : crossings(p, q)) {
            const bool within = c.t > q.tMin - tolerance && c.t < double(q.tMax) + tolerance;
            if (!within || c.margin < -kAcross) continue;
            e.possible.emplace_back(i, c.t);
            const bool surely = c.t > q.tMin + tolerance && c.t < double(q.tMax) - tolerance;
            if (surely && c.margin > kAcross) e.latest = std::min(e.latest, c.t);
        }
    }
    return e;
}

/// Some with zero components, some with an interval that ends inside the scene, some that start
/// on a primitive.
RayQuery randomRay(const GpuScene& scene, Random& random) {
    RayQuery q{};
    q.origin = random.inCube(random.below(2) ? 1.0f : 4.0f);
    q.direction =
        glm::normalize(random.below(2) ? random.direction() : random.inCube(1) - q.origin);
    q.tMax = random.below(4) ? kInfinite : random.uniform(0, 3);
    q.tMin = random.below(4) ? 0 : random.uniform(0, 1);
    q.skipPrimitive = gpu::NO_PRIMITIVE;
    const uint32_t kind = random.below(8);
    if (kind < 3) q.direction[int(kind)] = random.below(2) ? 0.0f : -0.0f;
    if (kind == 3) {
        const uint32_t i = random.below(uint32_t(scene.primitives.size()));
        const gpu::Primitive& p = scene.primitives[i];
        if (p.kind == gpu::PRIMITIVE_TRIANGLE) {
            q.origin = (p.v0 + p.v1 + p.v2) / 3.0f - 0.5f * q.direction;
            q.skipPrimitive = i;
        }
    }
    q.anyHit = random.below(2);
    return q;
}

class TraversalTest : public DeviceTest, public ::testing::WithParamInterface<bool> {
  protected:
    void trace(const GpuScene& scene, const std::vector<RayQuery>& queries) {
        ShaderOptions options;
        options.texelFetch = GetParam();
        options.set(SPEC_STACK_SIZE, scene.bvh.stackSize); // what the builder proves sufficient
        TestShader shader(GetParam() ? std::span<const uint32_t>(trace_texel)
                                     : std::span<const uint32_t>(trace_storage),
                          options);
        shader.setScene(scene);
        gpu::Dispatch constants{};
        constants.hardIterations = kStepLimit;
        answers_ = ask<RayAnswer>(shader, queries, constants);
    }

    void check(const GpuScene& scene, const std::vector<RayQuery>& queries) {
        trace(scene, queries);
        for (size_t i = 0; i < queries.size(); ++i)
            checkRay(scene, queries[i], answers_[i], i);
    }

    void checkRay(const GpuScene& scene, const RayQuery& q, const RayAnswer& a, size_t i) {
        const double tolerance = 1e-3;
        const Expectation e = expect(scene, q, tolerance);
        ASSERT_LT(a.steps, kStepLimit) << i;
        if (a.primitive == gpu::NO_PRIMITIVE) {
            EXPECT_EQ(e.latest, INFINITY) << "ray " << i << " missed";
            ++misses_;
            return;
        }
        ++hits_;
        EXPECT_TRUE(q.anyHit || a.t < e.latest + tolerance) << "ray " << i << ": not the closest";
        EXPECT_GT(a.t, q.tMin);
        EXPECT_LT(a.t, q.tMax);
        double nearest = INFINITY;
        for (const auto& [primitive, t] : e.possible)
            if (primitive == a.primitive) nearest = std::min(nearest, std::abs(t - a.t));
        EXPECT_LT(nearest, slopeTolerance(scene.primitives[a.primitive], q)) << "ray " << i;
        checkWeights(scene.primitives[a.primitive], q, a, i);
    }

    /// The point by the weights is the point along the ray.
    static void checkWeights(const gpu::Primitive& p, const RayQuery& q, const RayAnswer& a,
                             size_t i) {
        if (p.kind != gpu::PRIMITIVE_TRIANGLE) return;
        const glm::vec3 byWeights = (1 - a.b1 - a.b2) * p.v0 + a.b1 * p.v1 + a.b2 * p.v2;
        const glm::vec3 apart = byWeights - (q.origin + a.t * q.direction);
        EXPECT_LT(glm::length(apart), slopeTolerance(p, q)) << "ray " << i;
    }

    /// kAcross along the ray: over the cosine for triangles, the root for spheres.
    static double slopeTolerance(const gpu::Primitive& p, const RayQuery& q) {
        if (p.kind == gpu::PRIMITIVE_SPHERE) return std::sqrt(2 * p.v1.x * kAcross) + kAcross;
        const glm::dvec3 n = glm::cross(glm::dvec3(p.v1 - p.v0), glm::dvec3(p.v2 - p.v0));
        const double cosine = std::abs(glm::dot(n, glm::dvec3(q.direction))) / glm::length(n);
        return kAcross / std::max(cosine, 1e-9);
    }

    std::vector<RayAnswer> answers_;
    uint32_t hits_ = 0, misses_ = 0;
};

GpuScene pack(Scene scene, uint32_t maxLeafSize = 4) {
    scene.materials.resize(1);
    BuildOptions options;
    options.maxLeafSize = maxLeafSize;
    return packScene(scene, buildBinaryTree(primitiveBounds(scene), options), false);
}

TEST_P(TraversalTest, RandomSoups) {
    Random random(71);
    for (const uint32_t n : {1u, 2u, 3u, 5u, 17u, 300u})
        for (const uint32_t spheres : {0u, n / 2, n}) {
            const GpuScene scene =
                pack(soup(n - spheres, spheres, 1 / std::cbrt(float(n)), random), n % 4 + 1);
            std::vector<RayQuery> queries;
            for (int i = 0; i < 2500; ++i)
                queries.push_back(randomRay(scene, random));
            check(scene, queries);
        }
    EXPECT_GT(hits_, 5000u);
    EXPECT_GT(misses_, 5000u);
}

TEST_P(TraversalTest, ManyPrimitives) {
    Random random(72);
    const GpuScene scene = pack(soup(15000, 5000, 0.05f, random));
    std::vector<RayQuery> queries;
    for (int i = 0; i < 400; ++i)
        queries.push_back(randomRay(scene, random));
    check(scene, queries);
    EXPECT_GT(hits_, 100u);
}

TEST_P(TraversalTest, RaysThatAreNotFiniteHitNothingInBoundedTime) {
    Random random(73);
    const GpuScene scene = pack(soup(200, 50, 0.3f, random));
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    std::vector<RayQuery> queries;
    for (const float bad : {nan, infinity, -infinity, 3e38f})
        for (int i = 0; i < 6; ++i)
            for (int k = 0; k < 20; ++k) {
                if (bad == 3e38f && i >= 3) continue; // a direction like any other
                RayQuery q = randomRay(scene, random);
                (i < 3 ? q.origin : q.direction)[i % 3] = bad;
                queries.push_back(q);
            }
    for (int k = 0; k < 20; ++k) {
        RayQuery q = randomRay(scene, random);
        (k % 2 ? q.tMin : q.tMax) = nan;
        queries.push_back(q);
        q = randomRay(scene, random);
        q.direction = glm::vec3(k % 2 ? 0.0f : -0.0f);
        queries.push_back(q);
    }
    trace(scene, queries);
    for (size_t i = 0; i < queries.size(); ++i) {
        EXPECT_EQ(answers_[i].primitive, gpu::NO_PRIMITIVE) << i;
        EXPECT_LT(answers_[i].steps, 1000u) << i;
    }
}

TEST_P(TraversalTest, EmptySceneIsMissed) {
    Random random(74);
    const GpuScene scene = pack(Scene{});
    std::vector<RayQuery> queries;
    for (int i = 0; i < 100; ++i) {
        RayQuery q{};
        q.origin = random.inCube(2);
        q.direction = random.direction();
        q.tMax = kInfinite;
        queries.push_back(q);
    }
    trace(scene, queries);
    for (const RayAnswer& a : answers_) {
        EXPECT_EQ(a.primitive, gpu::NO_PRIMITIVE);
        EXPECT_LT(a.steps, 3u);
    }
}

INSTANTIATE_TEST_SUITE_P(Fetch, TraversalTest, ::testing::Bool(),
                         [](const auto& fetch) { return fetch.param ? "Texel" : "Storage"; });

} // namespace
} // namespace stromboli::test
