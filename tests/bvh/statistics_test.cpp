#include "host/bvh/node_record.hpp"
#include "host/bvh/statistics.hpp"
#include "tests/bvh/fixtures.hpp"
#include "tests/bvh/sweep_builder.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <vector>

namespace stromboli::test {
namespace {

/// Records a line visits if nothing ends it: all that it enters.
double visitsWithoutAnEnd(const Traceable& t, const TraversalRay& line) {
    const PreparedRay ray(line.origin, line.direction);
    uint32_t visits = 0;
    std::vector<uint32_t> pending{0};
    while (!pending.empty()) {
        const Record& record = t.layout.records[pending.back()];
        pending.pop_back();
        ++visits;
        if (!isNode(record)) continue;
        const uint32_t entered = enterChildren(asNode(record), ray, kInfiniteDistance);
        for (uint32_t slot = 0; slot < gpu::WIDE_CHILDREN; ++slot)
            if (entered >> (slot ^ ray.octant) & 1u)
                pending.push_back(bvh::firstChild(asNode(record)) + slot);
    }
    return visits;
}

TEST(Statistics, OfATreeByHand) {
    // A square of two triangles, and a sphere.
    Scene scene;
    addTriangle(scene, {0, 0, 0}, {1, 0, 0}, {1, 1, 0});
    addTriangle(scene, {0, 0, 0}, {1, 1, 0}, {0, 1, 0});
    Sphere sphere;
    sphere.center = {3.5f, 0.5f, 0.5f};
    sphere.radius = 0.5f;
    scene.spheres.push_back(sphere);
    const BvhStatistics s = measure(buildWideBvh(scene));
    EXPECT_EQ(s.nodes, 1u);
    EXPECT_EQ(s.leaves, 2u);
    EXPECT_EQ(s.depth, 1u);
    EXPECT_EQ(s.nodesOfSize[2], 1u);
    EXPECT_EQ(s.leavesOfSize[1], 1u);
    EXPECT_EQ(s.leavesOfSize[2], 1u);
    EXPECT_EQ(s.primitives, 3u);
    EXPECT_EQ(s.childrenPerNode(), 2);
    EXPECT_EQ(s.primitivesPerLeaf(), 1.5);
    // Half areas: the root 9, the square 1, the sphere 3. Boxes are larger by up to a cell of
    // 1/32 (x) or 1/128 on each side.
    EXPECT_NEAR(s.expectedVisits, 1 + (1.0 + 3.0) / 9, 0.03);
    // The root, two leaves, and what the root's first child's seven neighbours take.
    EXPECT_GE(s.recordBytes, 8u * 64u);
    EXPECT_EQ(s.bytesPerPrimitive(), double(s.recordBytes) / 3 + 16);
}

TEST(Statistics, OfNothing) {
    const BvhStatistics s = measure(buildWideBvh(Scene{}));
    EXPECT_EQ(s.nodes, 1u);
    EXPECT_EQ(s.leaves, 0u);
    EXPECT_EQ(s.nodesOfSize[0], 1u);
    EXPECT_EQ(s.expectedVisits, 1);
    EXPECT_EQ(s.bytesPerPrimitive(), 0);
    EXPECT_EQ(s.primitivesPerLeaf(), 0);
}

TEST(Statistics, MemoryOfMeshes) {
    Random random(50);
    for (const Scene& scene : {landscape(100), cubeMesh(40), starMesh(6, random)}) {
        BuildOptions options;
        options.split.most = 0;
        const BvhStatistics s = measure(buildWideBvh(scene, options));
        EXPECT_LE(s.bytesPerPrimitive(), 64);
        EXPECT_GE(s.primitivesPerLeaf(), 1.7);
        EXPECT_GE(s.childrenPerNode(), 5.5);
        EXPECT_LE(measure(buildWideBvh(scene)).recordBytes, 1.35 * double(s.recordBytes))
            << "0.3 leaves more, and the nodes that lead to them";
    }
}

TEST(Statistics, VisitsAreWhatRandomLinesMake) {
    // Lines through the root's box: from a point on it in a cosine-distributed direction.
    Random random(51);
    const Traceable t(soup(3000, 0, 0.2f, random));
    const gpu::NodeRecord root = asNode(t.layout.records[0]);
    bvh::GridBox box;
    for (uint32_t slot = 0; slot < gpu::WIDE_CHILDREN; ++slot)
        if (!bvh::childBox(root, slot).empty()) box.extend(bvh::childBox(root, slot));
    const glm::vec3 lo(box.lo), extent(box.hi - box.lo);
    const glm::vec3 area(extent.y * extent.z, extent.z * extent.x, extent.x * extent.y);
    double sum = 0, squares = 0;
    constexpr int kLines = 20000;
    for (int i = 0; i < kLines; ++i) {
        const float pick = random.uniform() * (area.x + area.y + area.z);
        const int axis = pick < area.x ? 0 : pick < area.x + area.y ? 1 : 2;
        const bool high = random.below(2) != 0;
        TraversalRay ray;
        ray.origin = lo + extent * glm::vec3(random.uniform(), random.uniform(), random.uniform());
        ray.origin[axis] = high ? lo[axis] + extent[axis] : lo[axis];
        glm::vec3 d;
        do
            d = random.inCube(1);
        while (glm::dot(d, d) > 1 || glm::dot(d, d) < 1e-4f);
        d = glm::normalize(d);
        d[axis] += high ? -1.0f : 1.0f;
        ray.direction = d;
        sum += visitsWithoutAnEnd(t, ray);
        squares += visitsWithoutAnEnd(t, ray) * visitsWithoutAnEnd(t, ray);
    }
    const double mean = sum / kLines;
    const double error = std::sqrt((squares / kLines - mean * mean) / kLines);
    // Five standard errors: wrong once in two million seeds; 0.2 % for the slack of boxes.
    const double expected = measure(t.layout).expectedVisits;
    EXPECT_NEAR(mean, expected, 5 * error + 0.002 * expected);
}

double relativeInnerArea(const BinaryTree& tree) {
    double area = 0;
    for (const BinaryNode& node : tree.nodes)
        if (!node.isLeaf()) area += node.bounds.halfArea();
    return area / tree.nodes[0].bounds.halfArea();
}

/// Binning may cost at most a tenth over trying every split.
void expectCloseToSweep(const char* name, const Scene& scene) {
    const std::vector<Bounds> boxes = boxesOf(scene);
    BuildOptions options;
    options.reinsert = false;
    const double binned = relativeInnerArea(buildBinaryTree(boxes, options));
    const double sweep = sweepInnerArea(boxes);
    std::cout << name << ": binned " << binned << ", sweep " << sweep << '\n';
    EXPECT_LE(binned, 1.1 * sweep) << name;
    EXPECT_GE(binned, 0.7 * sweep) << name << ": a cost this low is an error in counting it";
}

TEST(SahQuality, CloseToFullSweep) {
    Random random(7);
    expectCloseToSweep("soup", soup(3000, 1000, 0.05f, random));
    expectCloseToSweep("large soup triangles", soup(1000, 0, 0.5f, random));
    expectCloseToSweep("star", starMesh(4, random));
    expectCloseToSweep("cube", cubeMesh(16));
    expectCloseToSweep("landscape", landscape(48));
    expectCloseToSweep("cluster in soup", clusterInSoup(random));
    expectCloseToSweep("slivers", sliverStrip(1000));
}

} // namespace
} // namespace stromboli::test
