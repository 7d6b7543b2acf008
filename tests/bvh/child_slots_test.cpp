#include "host/bvh/wide_tree.hpp"
#include "host/core/random.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <vector>

namespace stromboli::test {
namespace {

using namespace bvh;

Bounds randomBox(Random& random) {
    const glm::vec3 a = random.inCube(1), b = a + random.inCube(0.3f);
    return {glm::min(a, b), glm::max(a, b)};
}

/// What the assignment maximises, written down again.
double gain(const std::vector<Bounds>& children, const std::vector<uint8_t>& slots) {
    Bounds all;
    for (const Bounds& b : children)
        all.extend(b);
    double sum = 0;
    for (size_t i = 0; i < children.size(); ++i)
        for (int axis = 0; axis < 3; ++axis) {
            const double offset = double(children[i].lo[axis]) + children[i].hi[axis] -
                                  double(all.lo[axis]) - all.hi[axis];
            sum += children[i].halfArea() * (slots[i] >> axis & 1 ? offset : -offset);
        }
    return sum;
}

TEST(ChildSlots, BestOfAllAssignments) {
    Random random(34);
    for (const size_t n : {1u, 2u, 5u, 8u, 8u}) {
        std::vector<Bounds> children;
        for (size_t i = 0; i < n; ++i)
            children.push_back(randomBox(random));
        std::vector<uint8_t> order(8);
        std::iota(order.begin(), order.end(), uint8_t(0));
        double best = -1e30;
        do
            best = std::max(best, gain(children, order));
        while (std::next_permutation(order.begin(), order.end()));
        const auto slots = assignSlots(children);
        const std::vector<uint8_t> chosen(slots.begin(), slots.begin() + std::ptrdiff_t(n));
        EXPECT_NEAR(gain(children, chosen), best, 1e-9 * std::abs(best)) << n;
        for (size_t i = 0; i < n; ++i)
            for (size_t j = 0; j < i; ++j)
                EXPECT_NE(chosen[i], chosen[j]);
    }
}

TEST(ChildSlots, OctantsAreVisitedFrontToBackFromEverywhere) {
    // Eight boxes in the octants of a cube, in any order.
    std::vector<Bounds> children;
    for (const uint32_t octant : {5u, 0u, 7u, 2u, 1u, 6u, 3u, 4u}) {
        const glm::vec3 lo(octant & 1, octant >> 1 & 1, octant >> 2);
        children.push_back({lo, lo + 0.9f});
    }
    const auto slots = assignSlots(children);
    for (uint32_t octant = 0; octant < 8; ++octant) {
        const glm::vec3 direction(octant & 1 ? 1 : -1, octant & 2 ? 1 : -1, octant & 4 ? 1 : -1);
        for (size_t i = 0; i < 8; ++i)
            for (size_t j = 0; j < 8; ++j) {
                // The highest bit first.
                const bool before = (slots[i] ^ octant) > (slots[j] ^ octant);
                const glm::vec3 from = children[i].lo - children[j].lo;
                const bool behindOnAllAxes =
                    glm::all(glm::greaterThanEqual(from * direction, glm::vec3(0)));
                if (before) {
                    EXPECT_FALSE(behindOnAllAxes) << octant;
                }
            }
    }
}

TEST(ChildSlots, BoxesWithoutAreaAreOrderedToo) {
    const std::vector<Bounds> points{{{1, 1, 1}, {1, 1, 1}}, {{-1, -1, -1}, {-1, -1, -1}}};
    const auto slots = assignSlots(points);
    EXPECT_EQ(slots[0], 7);
    EXPECT_EQ(slots[1], 0);
}

} // namespace
} // namespace stromboli::test
