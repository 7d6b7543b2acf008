// Every input gives a valid tree within the depth cap, or a clear refusal.

#include "host/bvh/binary_tree.hpp"
#include "host/bvh/primitive_bounds.hpp"
#include "host/core/error.hpp"
#include "tests/bvh/fixtures.hpp"
#include "tests/bvh/invariants.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <iostream>
#include <limits>

namespace stromboli::test {
namespace {

using testing::HasSubstr;
using testing::Property;
using testing::Throws;

std::vector<Bounds> boxesAt(const std::vector<glm::vec3>& centers, float half) {
    std::vector<Bounds> boxes;
    for (const glm::vec3& c : centers)
        boxes.push_back({c - half, c + half});
    return boxes;
}

void expectBuilds(const std::vector<Bounds>& boxes, const BuildOptions& options = {}) {
    const BinaryTree tree = buildBinaryTree(boxes, options);
    expectValidTree(tree, boxes, options);
    if (tree.nodes.size() > 1) expectValidLayout(layOut(tree), tree);
}

TEST(Build, SmallCounts) {
    Random random(1);
    for (const uint32_t maxLeafSize : {1u, 2u, 4u, 16u})
        for (const uint32_t n : {1u, 2u, 3u, 4u, 5u, 15u, 16u, 17u, 100u}) {
            BuildOptions options;
            options.maxLeafSize = maxLeafSize;
            expectBuilds(primitiveBounds(soup(n, 0, 0.1f, random)), options);
        }
}

TEST(Build, NothingGivesOneEmptyLeaf) {
    const BinaryTree tree = buildBinaryTree({});
    ASSERT_EQ(tree.nodes.size(), 1u);
    EXPECT_EQ(tree.nodes[0].count, 0u);
    EXPECT_TRUE(tree.nodes[0].bounds.empty());
    EXPECT_TRUE(tree.order.empty());
    EXPECT_EQ(tree.depth, 0u);
}

TEST(Build, IdenticalPrimitives) {
    expectBuilds(boxesAt(std::vector<glm::vec3>(10000, {1, 2, 3}), 0.5f));
    expectBuilds(boxesAt(std::vector<glm::vec3>(10000, {1, 2, 3}), 0.0f));
    expectBuilds(std::vector<Bounds>(5, {{-1, -1, -1}, {1, 1, 1}})); // largest leaf + 1
}

TEST(Build, SameCentroidsDifferentSizes) {
    std::vector<Bounds> boxes;
    for (int i = 1; i <= 10000; ++i)
        boxes.push_back({glm::vec3(float(-i)), glm::vec3(float(i))});
    expectBuilds(boxes);
}

TEST(Build, GeometricSeriesStaysWithinDepthCap) {
    // Every binned split peels off a few of the largest: deep without a cap.
    std::vector<Bounds> boxes;
    for (int copy = 0; copy < 20; ++copy)
        for (int i = -50; i < 140; ++i) {
            const float x = std::ldexp(1.0f, -i), y = x * (1 + 0.01f * float(copy));
            boxes.push_back({{x, y, 0}, {x * 1.1f, y * 1.1f, 0}});
        }
    expectBuilds(boxes);
    BuildOptions options;
    options.bins = 2;
    expectBuilds(boxes, options);
    options.maxLeafSize = 1;
    EXPECT_GT(buildBinaryTree(boxes, {1, 2, 1, 1, 200}).depth, 48u) << "the series is not hard";
    expectBuilds(boxes, options);
}

TEST(Build, SortedSliverStrip) {
    expectBuilds(primitiveBounds(sliverStrip(50000)));
}

TEST(Build, PointsOnALineAreSplitEvenly) {
    // No box has an area, so that every split costs nothing.
    std::vector<glm::vec3> centers;
    for (int i = 0; i < 4096; ++i)
        centers.push_back({float(i), 0, 0});
    const std::vector<Bounds> boxes = boxesAt(centers, 0);
    BuildOptions options;
    options.maxLeafSize = 1;
    const BinaryTree tree = buildBinaryTree(boxes, options);
    expectValidTree(tree, boxes, options);
    EXPECT_EQ(tree.depth, 12u);
}

TEST(Build, FlatScene) {
    Random random(2);
    Scene scene = soup(3000, 0, 0.05f, random);
    for (glm::vec3& p : scene.positions)
        p.z = 0;
    expectBuilds(primitiveBounds(scene));
}

TEST(Build, ExtremeCoordinates) {
    constexpr float kLargest = gpu::LARGEST_COORDINATE;
    constexpr float kDenormal = std::numeric_limits<float>::denorm_min();
    std::vector<Bounds> boxes{{glm::vec3(-kLargest), glm::vec3(kLargest)},
                              {glm::vec3(kLargest), glm::vec3(kLargest)},
                              {glm::vec3(-kLargest), glm::vec3(-kLargest)}};
    for (int i = 0; i < 50; ++i) {
        boxes.push_back({glm::vec3(float(i) * kDenormal), glm::vec3(float(i) * kDenormal)});
        boxes.push_back({glm::vec3(kLargest * 0.01f * float(i)), glm::vec3(kLargest)});
    }
    expectBuilds(boxes);
    boxes.erase(boxes.begin(), boxes.begin() + 3);
    std::erase_if(boxes, [](const Bounds& b) { return b.hi.x > 1; });
    expectBuilds(boxes); // all within 50 denormals: their reciprocal overflows
}

TEST(Build, DepthCapHoldsForEveryCapThatCanHold) {
    Random random(3);
    for (const uint32_t maxLeafSize : {1u, 3u, 4u, 16u})
        for (const uint32_t n : {1u, 7u, 64u, 65u, 1000u}) {
            std::vector<Bounds> boxes = primitiveBounds(soup(n, 0, 0.01f, random));
            for (Bounds& b : boxes) // crowded towards a corner, so that SAH trees get deep
                b.lo = b.lo * b.lo * b.lo, b.hi = b.lo + 1e-3f;
            uint32_t least = 0;
            while ((maxLeafSize << least) < n)
                ++least;
            for (uint32_t cap = least; cap < least + 6; ++cap) {
                BuildOptions options;
                options.maxLeafSize = maxLeafSize;
                options.depthCap = cap;
                expectBuilds(boxes, options);
            }
            if (least == 0) continue;
            BuildOptions options;
            options.maxLeafSize = maxLeafSize;
            options.depthCap = least - 1;
            EXPECT_THROW(buildBinaryTree(boxes, options), UsageError) << n << ' ' << maxLeafSize;
        }
}

TEST(Build, RejectsOptionsOutOfRange) {
    const std::vector<Bounds> boxes = boxesAt({{0, 0, 0}, {1, 0, 0}}, 0.1f);
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    const auto rejects = [&](auto change) {
        BuildOptions options;
        change(options);
        EXPECT_THROW(buildBinaryTree(boxes, options), UsageError);
        EXPECT_THROW(buildBinaryTree({}, options), UsageError);
    };
    for (const uint32_t size : {0u, 17u})
        rejects([size](BuildOptions& o) { o.maxLeafSize = size; });
    for (const uint32_t bins : {0u, 1u, 65u})
        rejects([bins](BuildOptions& o) { o.bins = bins; });
    for (const float cost : {-1.0f, kInfinity, kNaN})
        rejects([cost](BuildOptions& o) { o.traversalCost = cost; });
    for (const float cost : {0.0f, -1.0f, kInfinity, kNaN})
        rejects([cost](BuildOptions& o) { o.intersectionCost = cost; });
    rejects([](BuildOptions& o) { o.depthCap = 257; });
    EXPECT_NO_THROW(buildBinaryTree(boxes, {16, 64, 0, 1e-3f, 256}));
}

TEST(Build, RejectsUnusableBoxesAndNamesTheFirst) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    for (const float bad : {kNaN, kInfinity, -kInfinity, 2 * gpu::LARGEST_COORDINATE})
        for (int coordinate = 0; coordinate < 6; ++coordinate) {
            std::vector<Bounds> boxes(40000, {{0, 0, 0}, {1, 1, 1}});
            for (const size_t i : {30000u, 17u}) {
                Bounds& b = boxes[i];
                (coordinate < 3 ? b.lo : b.hi)[coordinate % 3] = bad;
            }
            EXPECT_THAT(
                [&] { buildBinaryTree(boxes); },
                Throws<SceneError>(Property(&SceneError::what, HasSubstr("primitive 17 "))));
        }
    EXPECT_THROW(buildBinaryTree(std::vector<Bounds>(2)), SceneError) << "empty boxes";
}

TEST(Build, RejectsMorePrimitivesThanReferencesCanName) {
    // The span claims 2^27 + 1 boxes that are not there: the count must be refused unread.
    const Bounds one{{0, 0, 0}, {1, 1, 1}};
    EXPECT_THROW(buildBinaryTree(std::span<const Bounds>(&one, (1u << 27) + 1)), SceneError);
}

TEST(Build, MillionTriangles) {
    Random random(4);
    const std::vector<Bounds> boxes = primitiveBounds(soup(1000000, 0, 0.005f, random));
    const auto start = std::chrono::steady_clock::now();
    const BinaryTree tree = buildBinaryTree(boxes);
    const std::chrono::duration<double> elapsed = std::chrono::steady_clock::now() - start;
    std::cout << "1e6 triangles: " << elapsed.count() << " s, " << tree.nodes.size()
              << " nodes, depth " << tree.depth << '\n';
    expectValidTree(tree, boxes, {});
    expectValidLayout(layOut(tree), tree);
}

} // namespace
} // namespace stromboli::test
