#include "host/bvh/leaf_items.hpp"
#include "tests/bvh/fixtures.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>

namespace stromboli::test {
namespace {

using namespace bvh;

glm::vec3 cornerOf(const Scene& scene, uint32_t triangle, uint32_t corner) {
    return scene.positions[scene.triangles[triangle].corner[corner % 3]];
}

double savedBy(const Scene& scene, uint32_t a, uint32_t b) {
    Bounds both = primitiveBounds(scene, a);
    both.extend(primitiveBounds(scene, b));
    return primitiveBounds(scene, a).halfArea() + primitiveBounds(scene, b).halfArea() -
           both.halfArea();
}

void expectValidPairs(const Scene& scene, const std::vector<TrianglePair>& pairs) {
    std::vector<int> timesPaired(scene.triangles.size(), 0);
    for (const TrianglePair& p : pairs) {
        EXPECT_LT(p.triangle[0], p.triangle[1]);
        for (const uint32_t t : p.triangle)
            EXPECT_EQ(++timesPaired.at(t), 1);
        EXPECT_EQ(cornerOf(scene, p.triangle[0], p.edge[0]),
                  cornerOf(scene, p.triangle[1], p.edge[1] + 1u));
        EXPECT_EQ(cornerOf(scene, p.triangle[0], p.edge[0] + 1u),
                  cornerOf(scene, p.triangle[1], p.edge[1]));
        EXPECT_GE(savedBy(scene, p.triangle[0], p.triangle[1]), -1e-6);
    }
}

/// Greedy by sorting all candidates; triangles of the scene must share positions' indices.
size_t pairsByGreedySorting(const Scene& scene) {
    std::map<std::pair<uint32_t, uint32_t>, uint32_t> triangleOfEdge;
    for (uint32_t t = 0; t < scene.triangles.size(); ++t)
        for (uint32_t c = 0; c < 3; ++c)
            triangleOfEdge[{scene.triangles[t].corner[c], scene.triangles[t].corner[(c + 1) % 3]}] =
                t;
    struct Candidate {
        double saved;
        uint32_t a, b;
    };
    std::vector<Candidate> candidates;
    for (const auto& [edge, a] : triangleOfEdge) {
        const auto other = triangleOfEdge.find({edge.second, edge.first});
        if (other == triangleOfEdge.end() || other->second < a) continue;
        const double saved = savedBy(scene, a, other->second);
        if (saved >= 0) candidates.push_back({saved, a, other->second});
    }
    std::sort(candidates.begin(), candidates.end(),
              [](const Candidate& x, const Candidate& y) { return x.saved > y.saved; });
    std::vector<bool> taken(scene.triangles.size(), false);
    size_t pairs = 0;
    for (const Candidate& c : candidates) {
        if (taken[c.a] || taken[c.b]) continue;
        taken[c.a] = taken[c.b] = true;
        ++pairs;
    }
    return pairs;
}

TEST(TrianglePairs, SameAsGreedyBySorting) {
    // Random radii: no two candidates save the same.
    Random random(35);
    for (const uint32_t levels : {1u, 3u, 5u}) {
        const Scene scene = starMesh(levels, random);
        const auto pairs = pairTriangles(scene);
        expectValidPairs(scene, pairs);
        EXPECT_EQ(pairs.size(), pairsByGreedySorting(scene));
    }
}

TEST(TrianglePairs, MeshesGiveWellFilledLeaves) {
    const Scene cube = cubeMesh(16);
    const auto pairs = pairTriangles(cube);
    expectValidPairs(cube, pairs);
    EXPECT_EQ(2 * pairs.size(), cube.triangles.size());
    Random random(36);
    const Scene star = starMesh(6, random); // as jagged as a mesh can be
    EXPECT_GT(double(2 * pairTriangles(star).size()), 0.85 * double(star.triangles.size()));
}

TEST(TrianglePairs, EqualPositionsCountAsOneUnlessTheirBitsDiffer) {
    Scene scene; // corners of their own
    addTriangle(scene, {0, 0, 0}, {1, 0, 0}, {1, 1, 0});
    addTriangle(scene, {0, 0, 0}, {1, 1, 0}, {0, 1, 0});
    ASSERT_EQ(pairTriangles(scene).size(), 1u);
    expectValidPairs(scene, pairTriangles(scene));
    scene.positions[3].x = -0.0f;
    EXPECT_TRUE(pairTriangles(scene).empty());
}

TEST(TrianglePairs, OnlyAcrossEdgesOfOppositeDirection) {
    Scene scene; // the second is turned over
    addTriangle(scene, {0, 0, 0}, {1, 0, 0}, {1, 1, 0});
    addTriangle(scene, {0, 0, 0}, {0, 1, 0}, {1, 1, 0});
    EXPECT_TRUE(pairTriangles(scene).empty());
}

TEST(TrianglePairs, NotWhereTheCommonBoxIsLarger) {
    Scene scene; // a roof: two thin triangles at a right angle, ends far apart
    addTriangle(scene, {0, 0, 0}, {0.1f, 0, 0}, {0, 10, 0});
    addTriangle(scene, {0.1f, 0, 0}, {0, 0, 0}, {0, 0, 10});
    EXPECT_LT(savedBy(scene, 0, 1), 0);
    EXPECT_TRUE(pairTriangles(scene).empty());
}

TEST(TrianglePairs, ManyTrianglesAtOneEdge) {
    Scene scene;
    for (uint32_t i = 0; i < 9; ++i) {
        const glm::vec3 tip(0.5f, 1, 0.1f * float(i));
        i % 2 ? addTriangle(scene, {0, 0, 0}, {1, 0, 0}, tip)
              : addTriangle(scene, {1, 0, 0}, {0, 0, 0}, tip);
    }
    const auto pairs = pairTriangles(scene);
    expectValidPairs(scene, pairs);
    EXPECT_EQ(pairs.size(), 4u);
}

TEST(TrianglePairs, LongChainsOfBetterNeighbours) {
    // Each triangle of this strip likes the next one best, as far as rounding lets it: walks along
    // much of it, each of which must not begin anew for every triangle.
    Scene scene;
    constexpr uint32_t kTriangles = 200000;
    float y = 0;
    for (uint32_t i = 0; i < kTriangles + 2; ++i) {
        scene.positions.push_back({float(i % 2), y, 0});
        y += 1e-5f * float(i + 1);
    }
    for (uint32_t i = 0; i < kTriangles; ++i) {
        Triangle t;
        t.corner[0] = i, t.corner[1] = i + 1 + i % 2, t.corner[2] = i + 2 - i % 2;
        scene.triangles.push_back(t);
    }
    const auto pairs = pairTriangles(scene);
    expectValidPairs(scene, pairs);
    EXPECT_GT(pairs.size(), size_t(0.98 * kTriangles / 2));
}

TEST(TrianglePairs, DegenerateTriangles) {
    Scene scene;
    addTriangle(scene, {0, 0, 0}, {0, 0, 0}, {1, 0, 0}); // there and back
    EXPECT_TRUE(pairTriangles(scene).empty());
    addTriangle(scene, {0, 0, 0}, {1, 0, 0}, {0, 1, 0});
    expectValidPairs(scene, pairTriangles(scene));
    EXPECT_TRUE(pairTriangles(Scene{}).empty());
}

} // namespace
} // namespace stromboli::test
