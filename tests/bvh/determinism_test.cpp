// The same boxes give the same bytes, whatever the number of threads.

#include "host/bvh/binary_tree.hpp"
#include "host/bvh/primitive_bounds.hpp"
#include "tests/bvh/fixtures.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cstring>

namespace stromboli::test {
namespace {

BinaryTree buildWith(int threads, const std::vector<Bounds>& boxes) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, size_t(threads));
    tbb::task_arena arena(threads); // as many threads even where there are fewer cores
    return arena.execute([&] { return buildBinaryTree(boxes); });
}

void expectSameBytes(const BinaryTree& a, const BinaryTree& b) {
    static_assert(std::has_unique_object_representations_v<BinaryNode> ||
                      sizeof(BinaryNode) == 6 * sizeof(float) + 4 * sizeof(uint32_t),
                  "padding would compare unequal");
    ASSERT_EQ(a.nodes.size(), b.nodes.size());
    EXPECT_EQ(std::memcmp(a.nodes.data(), b.nodes.data(), a.nodes.size() * sizeof(BinaryNode)), 0);
    EXPECT_EQ(a.order, b.order);
    EXPECT_EQ(a.depth, b.depth);
}

void expectDeterministic(const std::vector<Bounds>& boxes) {
    const BinaryTree alone = buildWith(1, boxes);
    for (const int threads : {1, 2, 3, 8, 8})
        expectSameBytes(buildWith(threads, boxes), alone);
}

TEST(Determinism, Soup) {
    Random random(5);
    expectDeterministic(primitiveBounds(soup(200000, 100000, 0.01f, random)));
}

TEST(Determinism, ManyEqualCentroidsAndZerosOfBothSigns) {
    // Which zero a minimum of +0 and -0 gives depends on the order of its arguments.
    Random random(6);
    std::vector<Bounds> boxes;
    for (int i = 0; i < 200000; ++i) {
        Bounds b;
        for (int axis = 0; axis < 3; ++axis) {
            const float zero = random.below(2) ? 0.0f : -0.0f;
            const float x = float(random.below(4));
            b.lo[axis] = random.below(2) ? zero : -x;
            b.hi[axis] = random.below(2) ? zero : x;
        }
        boxes.push_back(b);
    }
    expectDeterministic(boxes);
}

} // namespace
} // namespace stromboli::test
