// The traversal on the device against trying every primitive in double precision.
#include "host/kernel/kernel_features.hpp"
#include "host/vulkan/buffer.hpp"
#include "tests/bvh/fixtures.hpp"
#include "tests/shaders/placed.hpp"
#include "tests/shaders/queries.h"
#include "tests/shaders/ray_truth.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/test_shader.hpp"

#include "embedded/trace_storage.h"
#include "embedded/trace_texel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

namespace stromboli::test {
namespace {

using gpu::RayAnswer;
using gpu::RayQuery;

constexpr uint32_t kStepLimit = 20000;
constexpr size_t kTriedOneByOne = 1000; ///< records of a scene at most

/// Some with zero components, some with an interval that ends inside the scene, some that start
/// on a primitive.
RayQuery randomRay(const std::vector<Placed>& primitives, Random& random) {
    RayQuery q{};
    q.origin = random.inCube(random.below(2) ? 1.0f : 4.0f);
    q.direction = glm::normalize(random.below(2) ? random.vector() : random.inCube(1) - q.origin);
    q.tMax = random.below(4) ? kInfinite : random.uniform(0, 3);
    q.tMin = random.below(4) ? 0 : random.uniform(0, 1);
    q.skipPrimitive = gpu::NO_PRIMITIVE;
    const uint32_t kind = random.below(8);
    if (kind < 3) q.direction[int(kind)] = random.below(2) ? 0.0f : -0.0f;
    if (kind == 3) {
        const Placed& p = primitives[random.below(uint32_t(primitives.size()))];
        if (!p.isSphere) {
            q.origin = (p.v0 + p.v1 + p.v2) / 3.0f - 0.5f * q.direction;
            q.skipPrimitive = p.place;
        }
    }
    q.anyHit = random.below(2);
    return q;
}

/// How the scene is read, where the stack is, and what its entries are.
struct Variant {
    bool texelsAndRegisters;
    bool largeTree;
};

class TraversalTest : public DeviceTest, public ::testing::WithParamInterface<Variant> {
  protected:
    void trace(const GpuScene& scene, const std::vector<RayQuery>& queries) {
        ShaderOptions options;
        options.texelFetch = GetParam().texelsAndRegisters;
        options.set(SPEC_STACK_SIZE, scene.bvh.stackSize); // what the builder proves sufficient
        options.set(SPEC_STACK_IN_REGISTERS, GetParam().texelsAndRegisters);
        options.set(SPEC_LARGE_TREE, GetParam().largeTree);
        TestShader shader(GetParam().texelsAndRegisters ? std::span<const uint32_t>(trace_texel)
                                                        : std::span<const uint32_t>(trace_storage),
                          options);
        shader.setScene(scene);
        gpu::Dispatch constants{};
        constants.hardIterations = kStepLimit;
        if (scene.bvh.records.size() <= kTriedOneByOne)
            constants.segmentBase = uint32_t(scene.bvh.records.size());
        answers_ = ask<RayAnswer>(shader, queries, constants);
    }

    void check(const GpuScene& scene, const std::vector<RayQuery>& queries) {
        trace(scene, queries);
        const std::vector<Placed> primitives = placed(scene);
        for (size_t i = 0; i < queries.size(); ++i)
            checkRay(primitives, queries[i], answers_[i], i);
    }

    void checkRay(const std::vector<Placed>& primitives, const RayQuery& q, const RayAnswer& a,
                  size_t i) {
        const double tolerance = 1e-3;
        const Expectation e = expect(primitives, q, tolerance);
        ASSERT_LT(a.steps, kStepLimit) << i;
        checkAgainstAll(q, a, i);
        if (a.primitive == gpu::NO_PRIMITIVE) {
            EXPECT_EQ(e.latest, INFINITY) << "ray " << i << " missed";
            ++misses_;
            return;
        }
        ++hits_;
        const auto found = std::ranges::find(primitives, a.primitive, &Placed::place);
        ASSERT_NE(found, primitives.end()) << "ray " << i << " hits what is none";
        EXPECT_TRUE(q.anyHit || a.t < e.latest + tolerance) << "ray " << i << ": not the closest";
        EXPECT_GT(a.t, q.tMin);
        EXPECT_LT(a.t, q.tMax);
        double nearest = INFINITY;
        for (const auto& [place, t] : e.possible)
            if (place == a.primitive) nearest = std::min(nearest, std::abs(t - a.t));
        EXPECT_LT(nearest, slopeTolerance(*found, q)) << "ray " << i;
        checkWeights(*found, q, a, i);
    }

    /// Tests on every primitive give the same hit: the boxes lose none.
    static void checkAgainstAll(const RayQuery& q, const RayAnswer& a, size_t i) {
        if (a.bruteRecords == 0) return; // not tried
        EXPECT_EQ(a.primitive != gpu::NO_PRIMITIVE, a.bruteHits > 0) << "ray " << i;
        EXPECT_TRUE(q.anyHit || a.t == a.bruteT) << "ray " << i;
    }

    /// The point by the weights is the point along the ray.
    static void checkWeights(const Placed& p, const RayQuery& q, const RayAnswer& a, size_t i) {
        if (p.isSphere) return;
        const glm::vec3 byWeights = (1 - a.b1 - a.b2) * p.v0 + a.b1 * p.v1 + a.b2 * p.v2;
        const glm::vec3 apart = byWeights - (q.origin + a.t * q.direction);
        EXPECT_LT(glm::length(apart), slopeTolerance(p, q)) << "ray " << i;
    }

    /// kAcross along the ray: over the cosine for triangles, the root for spheres.
    static double slopeTolerance(const Placed& p, const RayQuery& q) {
        if (p.isSphere) return std::sqrt(2 * p.radius * kAcross) + kAcross;
        const glm::dvec3 n = glm::cross(glm::dvec3(p.v1 - p.v0), glm::dvec3(p.v2 - p.v0));
        const double cosine = std::abs(glm::dot(n, glm::dvec3(q.direction))) / glm::length(n);
        return kAcross / std::max(cosine, 1e-9);
    }

    std::vector<RayAnswer> answers_;
    uint32_t hits_ = 0, misses_ = 0;
};

std::vector<RayQuery> randomRays(const GpuScene& scene, int n, Random& random) {
    const std::vector<Placed> primitives = placed(scene);
    std::vector<RayQuery> queries;
    for (int i = 0; i < n; ++i)
        queries.push_back(randomRay(primitives, random));
    return queries;
}

TEST_P(TraversalTest, RandomSoups) {
    Random random(71);
    for (const uint32_t n : {1u, 2u, 3u, 5u, 17u, 300u})
        for (const uint32_t spheres : {0u, n / 2, n}) {
            const GpuScene scene =
                pack(soup(n - spheres, spheres, 1 / std::cbrt(float(n)), random));
            check(scene, randomRays(scene, 2500, random));
        }
    EXPECT_GT(hits_, 5000u);
    EXPECT_GT(misses_, 5000u);
}

TEST_P(TraversalTest, ManyPrimitives) {
    Random random(72);
    const GpuScene scene = pack(soup(15000, 5000, 0.05f, random));
    check(scene, randomRays(scene, 400, random));
    EXPECT_GT(hits_, 100u);
}

/// Meshes, whose triangles share edges and leaves.
TEST_P(TraversalTest, Meshes) {
    Random random(75);
    for (const Scene& mesh : {landscape(20), starMesh(2, random), cubeMesh(5), sliverStrip(100)}) {
        const GpuScene scene = pack(mesh);
        check(scene, randomRays(scene, 2000, random));
    }
    EXPECT_GT(hits_, 1500u);
}

/// Nodes tiny against the rays' distance, whose absent children the slack of the boxes may reach.
TEST_P(TraversalTest, FromAfar) {
    Random random(77);
    Scene scene = soup(60, 60, 0.5f, random);
    const GpuScene packed = pack(scene);
    const std::vector<Placed> primitives = placed(packed);
    std::vector<RayQuery> queries;
    for (int i = 0; i < 5000; ++i) {
        const Placed& p = primitives[random.below(uint32_t(primitives.size()))];
        RayQuery q{};
        q.origin = std::pow(10.0f, random.uniform(3, 8)) * random.vector();
        q.direction = p.v0 + 0.1f * random.inCube(1) - q.origin;
        q.tMax = kInfinite;
        q.skipPrimitive = gpu::NO_PRIMITIVE;
        queries.push_back(q);
    }
    trace(packed, queries);
    const auto nodes = std::ranges::count_if(packed.bvh.records, isNode);
    for (size_t i = 0; i < queries.size(); ++i) {
        checkAgainstAll(queries[i], answers_[i], i);
        EXPECT_LE(answers_[i].steps, 1 + 8 * nodes) << i << ": a node more than once";
        EXPECT_LT(answers_[i].highestEntry, packed.bvh.stackSize) << i;
    }
}

TEST_P(TraversalTest, RaysThatAreNotFiniteHitNothingInBoundedTime) {
    Random random(73);
    const GpuScene scene = pack(soup(200, 50, 0.3f, random));
    const std::vector<Placed> primitives = placed(scene);
    const float nan = std::numeric_limits<float>::quiet_NaN();
    const float infinity = std::numeric_limits<float>::infinity();
    std::vector<RayQuery> queries;
    for (const float bad : {nan, infinity, -infinity, 3e38f})
        for (int i = 0; i < 6; ++i)
            for (int k = 0; k < 20; ++k) {
                if (bad == 3e38f && i >= 3) continue; // a direction like any other
                RayQuery q = randomRay(primitives, random);
                (i < 3 ? q.origin : q.direction)[i % 3] = bad;
                queries.push_back(q);
            }
    for (int k = 0; k < 20; ++k) {
        RayQuery q = randomRay(primitives, random);
        (k % 2 ? q.tMin : q.tMax) = nan;
        queries.push_back(q);
        q = randomRay(primitives, random);
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
        q.direction = random.vector();
        q.tMax = kInfinite;
        queries.push_back(q);
    }
    trace(scene, queries);
    for (const RayAnswer& a : answers_) {
        EXPECT_EQ(a.primitive, gpu::NO_PRIMITIVE);
        EXPECT_LT(a.steps, 3u);
    }
}

/// Long triangles all over each other: rays enter every child of most nodes.
TEST_F(DeviceTest, TheStackIsAsDeepAsTheBuilderSays) {
    Random random(76);
    bool full = false;
    for (const uint32_t n : {1u, 9u, 100u, 3000u}) {
        const GpuScene scene = pack(soup(n, n / 10, 3, random));
        TestShader shader(trace_texel, ShaderOptions::texel()); // a stack larger than needed
        ASSERT_LT(scene.bvh.stackSize, 64u);
        shader.setScene(scene);
        gpu::Dispatch constants{};
        constants.hardIterations = kStepLimit;
        uint32_t highest = 0;
        const std::vector<RayQuery> rays = randomRays(scene, 2000, random);
        const auto found = ask<RayAnswer>(shader, rays, constants);
        for (const RayAnswer& a : found)
            highest = std::max(highest, a.highestEntry);
        EXPECT_LT(highest, scene.bvh.stackSize) << n;
        // A stack of that size in registers (traversal_stack.glsl) does the same.
        TestShader small(trace_texel, ShaderOptions::texel()
                                          .set(SPEC_STACK_SIZE, scene.bvh.stackSize)
                                          .set(SPEC_STACK_IN_REGISTERS, 1));
        small.setScene(scene);
        EXPECT_EQ(std::memcmp(ask<RayAnswer>(small, rays, constants).data(), found.data(),
                              found.size() * sizeof(RayAnswer)),
                  0)
            << n;
        full |= n > 100 && highest + 1 == scene.bvh.stackSize;
    }
    EXPECT_TRUE(full) << "the bound is loose";
}

/// This tree with `records` unused ones behind the root.
GpuScene movedBack(GpuScene scene, uint32_t records) {
    for (Record& r : scene.bvh.records)
        if (isNode(r)) {
            gpu::NodeRecord node = asNode(r);
            node.firstChild += records;
            r = std::bit_cast<Record>(node);
        } else if (gpu::LeafRecord leaf = asLeaf(r); !(leaf.primitive & gpu::RECORD_IS_SPHERE)) {
            leaf.homeOrRadius += records;
            r = std::bit_cast<Record>(leaf);
        }
    scene.bvh.records.insert(scene.bvh.records.begin() + 1, records, Record{});
    return scene;
}

/// Record numbers that 24 bits cannot hold. The kernel that keeps them in one word with the slots
/// finds something else, or nothing.
TEST_F(DeviceTest, TreesOfMoreThanSixteenMillionRecords) {
    Random random(78);
    const GpuScene scene = pack(soup(300, 30, 0.3f, random));
    constexpr uint32_t kBehind = gpu::SMALL_TREE_RECORDS + 5;
    const uint64_t bytes = (kBehind + scene.bvh.records.size()) * sizeof(Record);
    if (vulkan::bindingLimit(testDevice().description(), vulkan::BufferUse::Texel).bytes < bytes)
        GTEST_SKIP() << "texel buffers of this device hold fewer";
    std::vector<RayQuery> rays = randomRays(scene, 1000, random);
    for (RayQuery& ray : rays)
        ray.skipPrimitive = gpu::NO_PRIMITIVE; // places are other ones in the moved tree
    const GpuScene moved = movedBack(scene, kBehind);
    EXPECT_FALSE(kernelFeatures(scene, Camera{}, Estimator{}, {})[SPEC_LARGE_TREE]);
    EXPECT_TRUE(kernelFeatures(moved, Camera{}, Estimator{}, {})[SPEC_LARGE_TREE]);

    gpu::Dispatch constants{};
    constants.hardIterations = kStepLimit;
    const auto answersOf = [&](const GpuScene& s, bool largeTree) {
        TestShader shader(trace_texel, ShaderOptions::texel().set(SPEC_LARGE_TREE, largeTree));
        shader.setScene(s);
        return ask<RayAnswer>(shader, rays, constants);
    };
    const auto expected = answersOf(scene, false), found = answersOf(moved, true),
               tooSmall = answersOf(moved, false);
    uint32_t hits = 0, lost = 0;
    for (size_t i = 0; i < rays.size(); ++i) {
        const bool hit = expected[i].primitive != gpu::NO_PRIMITIVE;
        const uint32_t place = hit ? expected[i].primitive + 2 * kBehind : gpu::NO_PRIMITIVE;
        EXPECT_EQ(found[i].t, expected[i].t) << i;
        EXPECT_EQ(found[i].primitive, place) << i;
        hits += hit;
        lost += hit && tooSmall[i].primitive != place;
    }
    EXPECT_GT(hits, 300u);
    EXPECT_EQ(lost, hits) << "negative control";
}

INSTANTIATE_TEST_SUITE_P(Fetch, TraversalTest,
                         ::testing::Values(Variant{false, false}, Variant{true, false},
                                           Variant{false, true}, Variant{true, true}),
                         [](const auto& p) {
                             return std::string(p.param.texelsAndRegisters ? "Texel" : "Storage") +
                                    (p.param.largeTree ? "LargeTree" : "");
                         });

} // namespace
} // namespace stromboli::test
