// Every input gives a valid tree within the depth cap, or a clear refusal.

#include "host/bvh/binary_tree.hpp"
#include "host/core/error.hpp"
#include "shaders/shared/scene_types.h"
#include "tests/bvh/fixtures.hpp"
#include "tests/bvh/invariants.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
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

/// Both with and without moving subtrees afterwards.
void expectBuilds(const std::vector<Bounds>& boxes, BuildOptions options = {}) {
    for (const bool reinsert : {false, true}) {
        options.reinsert = reinsert;
        expectValidTree(buildBinaryTree(boxes, options), boxes, options.depthCap);
    }
}

TEST(Build, SmallCounts) {
    Random random(1);
    for (const uint32_t n : {1u, 2u, 3u, 4u, 5u, 15u, 16u, 17u, 100u})
        expectBuilds(boxesOf(soup(n, 0, 0.1f, random)));
}

TEST(Build, NothingGivesNoNodes) {
    const BinaryTree tree = buildBinaryTree({});
    EXPECT_TRUE(tree.nodes.empty());
    EXPECT_EQ(tree.depth, 0u);
}

TEST(Build, IdenticalBoxes) {
    expectBuilds(boxesAt(std::vector<glm::vec3>(10000, {1, 2, 3}), 0.5f));
    expectBuilds(boxesAt(std::vector<glm::vec3>(10000, {1, 2, 3}), 0.0f));
    expectBuilds(std::vector<Bounds>(5, {{-1, -1, -1}, {1, 1, 1}}));
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
    EXPECT_GT(buildBinaryTree(boxes, {2, 200, false}).depth, 48u) << "the series is not hard";
    expectBuilds(boxes, options);
}

TEST(Build, SortedSliverStrip) {
    expectBuilds(boxesOf(sliverStrip(50000)));
}

TEST(Build, PointsOnALineAreSplitEvenly) {
    // No box has an area, so that every split costs nothing.
    std::vector<glm::vec3> centers;
    for (int i = 0; i < 4096; ++i)
        centers.push_back({float(i), 0, 0});
    const std::vector<Bounds> boxes = boxesAt(centers, 0);
    const BinaryTree tree = buildBinaryTree(boxes);
    expectValidTree(tree, boxes, 48);
    EXPECT_EQ(tree.depth, 12u);
}

TEST(Build, FlatScene) {
    Random random(2);
    Scene scene = soup(3000, 0, 0.05f, random);
    for (glm::vec3& p : scene.positions)
        p.z = 0;
    expectBuilds(boxesOf(scene));
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
    for (const uint32_t n : {1u, 7u, 64u, 65u, 1000u}) {
        std::vector<Bounds> boxes = boxesOf(soup(n, 0, 0.01f, random));
        for (Bounds& b : boxes) // crowded towards a corner, so that SAH trees get deep
            b.lo = b.lo * b.lo * b.lo, b.hi = b.lo + 1e-3f;
        uint32_t least = 0;
        while ((1u << least) < n)
            ++least;
        BuildOptions options;
        for (options.depthCap = least; options.depthCap < least + 6; ++options.depthCap)
            expectBuilds(boxes, options);
        if (least == 0) continue;
        options.depthCap = least - 1;
        EXPECT_THROW(buildBinaryTree(boxes, options), UsageError) << n;
    }
}

TEST(Build, RejectsOptionsOutOfRange) {
    const std::vector<Bounds> boxes = boxesAt({{0, 0, 0}, {1, 0, 0}}, 0.1f);
    const auto rejects = [&](auto change) {
        BuildOptions options;
        change(options);
        EXPECT_THROW(buildBinaryTree(boxes, options), UsageError);
        EXPECT_THROW(buildBinaryTree({}, options), UsageError);
    };
    for (const uint32_t bins : {0u, 1u, 65u})
        rejects([bins](BuildOptions& o) { o.bins = bins; });
    rejects([](BuildOptions& o) { o.depthCap = 257; });
    EXPECT_NO_THROW(buildBinaryTree(boxes, {64, 256, true}));
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
            EXPECT_THAT([&] { buildBinaryTree(boxes); },
                        Throws<SceneError>(Property(&SceneError::what, HasSubstr("leaf 17 "))));
        }
    EXPECT_THROW(buildBinaryTree(std::vector<Bounds>(2)), SceneError) << "empty boxes";
}

TEST(Build, RejectsMoreItemsThanRecords) {
    // The span claims 2^24 + 1 boxes that are not there: the count must be refused unread.
    const Bounds one{{0, 0, 0}, {1, 1, 1}};
    EXPECT_THROW(buildBinaryTree(std::span<const Bounds>(&one, gpu::MAX_RECORDS + 1)), SceneError);
}

} // namespace
} // namespace stromboli::test
