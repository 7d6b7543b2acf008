// A scene gives the same bytes, whatever the number of threads.

#include "host/bvh/wide_layout.hpp"
#include "tests/bvh/fixtures.hpp"

#include <gtest/gtest.h>
#include <tbb/global_control.h>
#include <tbb/task_arena.h>

#include <cstring>

namespace stromboli::test {
namespace {

template <class Function>
auto withThreads(int threads, Function function) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, size_t(threads));
    tbb::task_arena arena(threads); // as many threads even where there are fewer cores
    return arena.execute(function);
}

constexpr int kThreads[] = {2, 3, 8};

void expectDeterministic(const Scene& scene) {
    const auto build = [&] { return buildWideBvh(scene); };
    const WideLayout alone = withThreads(1, build);
    for (const int threads : kThreads) {
        const WideLayout other = withThreads(threads, build);
        EXPECT_EQ(other.records, alone.records);
        EXPECT_EQ(other.primitiveOrder, alone.primitiveOrder);
        EXPECT_EQ(other.placeOf, alone.placeOf);
        EXPECT_EQ(other.firstCorner, alone.firstCorner);
        EXPECT_EQ(other.stackSize, alone.stackSize);
    }
}

TEST(Determinism, Soup) {
    // Enough items for every loop to be divided.
    Random random(5);
    expectDeterministic(soup(60000, 40000, 0.02f, random));
}

TEST(Determinism, MeshInARoom) {
    Scene scene = landscape(200);
    addRoom(scene);
    expectDeterministic(scene);
}

TEST(Determinism, ManyEqualCentroidsAndZerosOfBothSigns) {
    // Which zero a minimum of +0 and -0 gives depends on the order of its arguments.
    Random random(6);
    std::vector<Bounds> boxes;
    for (int i = 0; i < 100000; ++i) {
        Bounds b;
        for (int axis = 0; axis < 3; ++axis) {
            const float zero = random.below(2) ? 0.0f : -0.0f;
            const float x = float(random.below(4));
            b.lo[axis] = random.below(2) ? zero : -x;
            b.hi[axis] = random.below(2) ? zero : x;
        }
        boxes.push_back(b);
    }
    const auto build = [&] { return buildBinaryTree(boxes); };
    const BinaryTree alone = withThreads(1, build);
    static_assert(sizeof(BinaryNode) == 6 * sizeof(float) + 2 * sizeof(uint32_t),
                  "padding would compare unequal");
    for (const int threads : kThreads) {
        const BinaryTree other = withThreads(threads, build);
        ASSERT_EQ(other.nodes.size(), alone.nodes.size());
        EXPECT_EQ(std::memcmp(other.nodes.data(), alone.nodes.data(),
                              alone.nodes.size() * sizeof(BinaryNode)),
                  0);
    }
}

} // namespace
} // namespace stromboli::test
