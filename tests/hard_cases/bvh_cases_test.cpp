// Hard cases 18 to 28 that are not in `stromboli stress`: trees over what is hard to split, boxes,
// and rays that would not end.
#include "host/bvh/leaf_items.hpp"
#include "host/bvh/node_record.hpp"
#include "host/core/error.hpp"
#include "host/stress/device_subject.hpp"
#include "host/vulkan/buffer.hpp"
#include "tests/bvh/fixtures.hpp"
#include "tests/bvh/invariants.hpp"
#include "tests/hard_cases/hits.hpp"
#include "tests/hard_cases/naive_intersection.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace stromboli::test {
namespace {

/// Depth of the tree that splits at the middle of the centroids' box, down to `leaf` items a leaf:
/// what common builders do. Stops at `most`: the recursion would not end, or the stack would not
/// do.
uint32_t depthBySpatialMiddle(std::vector<Bounds> items, size_t leaf, uint32_t most) {
    uint32_t depth = 0;
    while (items.size() > leaf && depth < most) {
        Bounds centroids;
        for (const Bounds& b : items)
            centroids.extend(0.5f * (b.lo + b.hi));
        const glm::vec3 extent = centroids.extent();
        const int axis = extent.x >= extent.y && extent.x >= extent.z ? 0
                         : extent.y >= extent.z                       ? 1
                                                                      : 2;
        const float middle = 0.5f * (centroids.lo[axis] + centroids.hi[axis]);
        std::vector<Bounds> low, high;
        for (const Bounds& b : items)
            (0.5f * (b.lo + b.hi)[axis] < middle ? low : high).push_back(b);
        items = low.size() > high.size() ? std::move(low) : std::move(high); // the larger half
        ++depth;
    }
    return depth;
}

constexpr uint32_t kStack = 64; ///< entries that many traversals have

TEST_F(HardCases, C18_FewPrimitives) {
    Random random(1118);
    for (const uint32_t n : {0u, 1u, 2u, 3u, 4u, 7u, 8u, 9u, 15u, 16u, 17u}) {
        const Scene scene = soup(n, 0, 0.5f, random);
        expectValidLayout(buildWideBvh(scene), scene);
    }
    // Negative control: two items whose centroids are equal, a leaf of one.
    EXPECT_EQ(depthBySpatialMiddle(std::vector<Bounds>(2, {{0, 0, 0}, {1, 1, 1}}), 1, 1000), 1000u);
}

TEST_F(HardCases, C19_EqualCentroids) {
    Scene copies;
    for (int i = 0; i < 10000; ++i)
        addTriangle(copies, {-1, -1, 0}, {1, -1, 0}, {0, 1, 0});
    expectValidLayout(buildWideBvh(copies), copies);
    EXPECT_LE(buildBinaryTree(boxesOf(copies)).depth, BuildOptions{}.depthCap);
    EXPECT_EQ(depthBySpatialMiddle(boxesOf(copies), 4, 1000), 1000u) << "negative control";
}

TEST_F(HardCases, C20_GeometricSeriesAndSlivers) {
    Scene series;
    for (int copy = 0; copy < 20; ++copy)
        for (int i = -50; i < 100; ++i) {
            const float x = std::ldexp(1 + 0.01f * float(copy), -i);
            addTriangle(series, {x, 0, 0}, {x, x, 0}, {x, 0, x});
        }
    for (const Scene& scene : {series, sliverStrip(20000)}) {
        const WideLayout layout = buildWideBvh(scene);
        expectValidLayout(layout, scene);
        EXPECT_LE(buildBinaryTree(boxesOf(scene)).depth, BuildOptions{}.depthCap);
        EXPECT_LE(layout.stackSize, kStack);
    }
    EXPECT_GT(depthBySpatialMiddle(boxesOf(series), 4, 1000), kStack) << "negative control";
}

/// Everything in a plane: boxes without thickness, met from the front, and along axes from their
/// very edges.
TEST_F(HardCases, C21_FlatScene) {
    Scene scene = cubeMesh(8);
    std::erase_if(scene.triangles, [&](const Triangle& t) {
        return std::ranges::any_of(t.corner,
                                   [&](uint32_t c) { return scene.positions[c].z != -1; });
    });
    for (glm::vec3& p : scene.positions)
        p.z = 0;
    scene.materials.resize(1);
    std::vector<stress::Ray> rays;
    uint32_t lost = 0;
    for (int i = 0; i <= 32; ++i)
        for (int k = 0; k <= 32; ++k) { // corners, edges and insides of the squares; the rim
            const glm::vec3 at(float(i) / 16 - 1, float(k) / 16 - 1, 0);
            rays.push_back({at + glm::vec3(0, 0, 2), naive::kMissed, {0, -0.0f, -1}, 0});
            rays.push_back({at - glm::vec3(0.5f, 0, 2), naive::kMissed, {0.25f, 0, 1}, 0});
            lost += !naive::entersBox({-1, -1, 0}, {1, 1, 0}, rays.back().origin,
                                      rays.back().direction, naive::kMissed);
        }
    const WideLayout layout = buildWideBvh(scene);
    expectValidLayout(layout, scene);
    stress::DeviceSubject device(testDevice());
    for (const float t : device.tracer(scene)->distances(rays))
        EXPECT_EQ(t, 2);
    for (const stress::Ray& r : rays) {
        TraversalRay ray;
        ray.origin = r.origin, ray.direction = r.direction;
        EXPECT_EQ(closestHit(layout, ray).t, 2);
    }
    EXPECT_EQ(lost, 33 * 33u) << "negative control: entry < exit, where both are equal";
}

/// Rays that start inside boxes, and ends before, at and after the hit: the interval is open.
TEST_F(HardCases, C23_OriginInsideBoxesAndOpenIntervals) {
    Scene scene;
    for (const float z : {-3.0f, -1.0f, 1.0f, 3.0f})
        addTriangle(scene, {-4, -4, z - 0.5f}, {4, -4, z + 0.5f}, {0, 8, z}); // boxes overlap at 0
    scene.materials.resize(1);
    stress::DeviceSubject device(testDevice());
    const auto tracer = device.tracer(scene);
    const auto distance = [&](const glm::vec3& origin, float tMax) {
        return tracer->distances(std::vector<stress::Ray>{{origin, tMax, {0, 0, 1}, 0}})[0];
    };
    EXPECT_FLOAT_EQ(distance({0, 0, 0.9f}, naive::kMissed), 1.0f - 0.9f) << "from within the box";
    EXPECT_EQ(distance({0, 0, 0}, naive::kMissed), 1);
    EXPECT_EQ(distance({0, 0, 0}, std::nextafter(1.0f, 2.0f)), 1);
    EXPECT_EQ(distance({0, 0, 0}, 1), naive::kMissed) << "the end does not count";
    EXPECT_EQ(distance({0, 0, 0}, 0.5f), naive::kMissed);
    EXPECT_EQ(distance({0, 0, 1}, naive::kMissed), 3 - 1.0f) << "nor does the beginning";
    // Negative control: a box counts where it is entered, which is behind the origin.
    const float entered = (0.5f - 0.9f) / 1;
    EXPECT_FALSE(entered > 0) << "negative control";
}

/// Planes on the grid by rounding to the nearest hold the boxes of half the children only.
TEST_F(HardCases, C25_BoxesHoldWhatIsBelowThem) {
    Random random(1125);
    for (const Scene& scene : {soup(3000, 500, 0.1f, random), landscape(40), clusterInSoup(random)})
        expectValidLayout(buildWideBvh(scene), scene);
    int naiveOutside = 0, outside = 0;
    for (int i = 0; i < 1000; ++i) {
        const double low = random.uniform(-1, 0), high = random.uniform(0, 1);
        const bvh::AxisGrid grid = bvh::gridOver(-1, 1);
        const auto at = [&](double plane) { return double(grid.origin) + plane * grid.cell(); };
        naiveOutside += at(std::round((low - grid.origin) / grid.cell())) > low ||
                        at(std::round((high - grid.origin) / grid.cell())) < high;
        outside += at(bvh::planeBelow(grid, low)) > low || at(bvh::planeAbove(grid, high)) < high;
    }
    EXPECT_EQ(outside, 0);
    EXPECT_GT(naiveOutside, 500) << "negative control: the nearest planes";
}

bool sameBytes(const WideLayout& a, const WideLayout& b) {
    return a.records == b.records && a.primitiveOrder == b.primitiveOrder &&
           a.placeOf == b.placeOf && a.firstCorner == b.firstCorner;
}

TEST_F(HardCases, C26_TheSameBytesEveryTime) {
    Random random(1126);
    Scene scene = soup(20000, 100, 0.05f, random);
    const WideLayout once = buildWideBvh(scene);
    EXPECT_TRUE(sameBytes(buildWideBvh(scene), once));
    for (const size_t threads : {1, 3}) {
        const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
        EXPECT_TRUE(sameBytes(buildWideBvh(scene), once)) << threads << " threads";
    }
    // What comes back from the device is what was sent.
    vulkan::Buffer buffer(testDevice(), "records", once.records.size() * sizeof(Record),
                          vulkan::BufferUse::Storage);
    buffer.upload(testQueue(), std::as_bytes(std::span(once.records)));
    std::vector<Record> back(once.records.size());
    buffer.download(testQueue(), std::as_writable_bytes(std::span(back)));
    EXPECT_EQ(back, once.records);
    // Negative control: items in the order in which threads happen to hand them in.
    std::swap(scene.triangles[17], scene.triangles[10000]);
    EXPECT_FALSE(sameBytes(buildWideBvh(scene), once)) << "negative control";
}

/// Records visited by rays with a part that is not finite: none, against some tens by the others.
/// By the slab test as it is often written ("unless it exits before it enters") NaN enters every
/// box.
TEST_F(HardCases, C27_RaysThatAreNotFiniteEndAtOnce) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
    Random random(1127);
    const Scene scene = soup(5000, 0, 0.1f, random);
    const WideLayout layout = buildWideBvh(scene);
    const auto visits = [&](const TraversalRay& ray) {
        TraversalCounts counts;
        EXPECT_FALSE(closestHit(layout, ray, &counts) && !std::isfinite(ray.origin.x));
        return counts.nodes + counts.leaves;
    };
    uint32_t usual = 0, most = 0;
    for (int i = 0; i < 1000; ++i) {
        TraversalRay ray;
        ray.origin = random.inCube(1), ray.direction = random.vector();
        usual += visits(ray);
        for (const float bad : {kNaN, -kNaN, kInfinity, -kInfinity}) {
            TraversalRay spoilt = ray;
            (i % 2 ? spoilt.origin : spoilt.direction)[i % 3] = bad;
            most = std::max(most, visits(spoilt));
        }
    }
    EXPECT_LE(most, 2.5 * usual / 1000.0);
    uint32_t entered = 0;
    const std::vector<Bounds> boxes = boxesOf(scene);
    for (const Bounds& b : boxes) {
        float enter = 0, leave = naive::kMissed;
        for (int k = 0; k < 3; ++k) { // direction NaN
            const float t0 = (b.lo[k] - 0) / kNaN, t1 = (b.hi[k] - 0) / kNaN;
            enter = std::max(enter, std::min(t0, t1)), leave = std::min(leave, std::max(t0, t1));
        }
        entered += !(leave < enter);
    }
    EXPECT_EQ(entered, boxes.size()) << "negative control: NaN enters every box";
}

TEST_F(HardCases, C28_MoreThanFloatsCanCountAndLimitsHold) {
    // An index beyond 2^24 in a float is another record's.
    EXPECT_EQ(uint32_t(float((1u << 24) + 1)), 1u << 24) << "negative control";
    // Small trees name a record by 24 bits, with the slots below; large ones by a word whose rows
    // are numbered by another. The last one fits; one more is refused.
    EXPECT_EQ(((gpu::SMALL_TREE_RECORDS - 1) << 8) >> 8, gpu::SMALL_TREE_RECORDS - 1);
    EXPECT_EQ(gpu::MAX_RECORDS - 1, (gpu::MAX_RECORDS - 1) & gpu::RECORD_INDEX_MASK);
    EXPECT_LT(uint64_t(gpu::MAX_RECORDS) * gpu::RECORD_ROWS - 1, uint64_t(1) << 32);
    const Bounds one{{0, 0, 0}, {1, 1, 1}};
    EXPECT_THROW(buildBinaryTree(std::span<const Bounds>(&one, gpu::MAX_RECORDS + 1)), SceneError);
    const vulkan::DeviceDescription& device = testDevice().description();
    const uint64_t tooMuch = vulkan::bindingLimit(device, vulkan::BufferUse::Storage).bytes + 16;
    EXPECT_THAT(
        [&] {
            vulkan::requireFits(device, {"BVH buffer", tooMuch, vulkan::BufferUse::Storage});
        },
        testing::Throws<DeviceError>(
            testing::Property(&DeviceError::what, testing::HasSubstr("BVH buffer"))));
}

} // namespace
} // namespace stromboli::test
