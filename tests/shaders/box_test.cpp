// enterChildren of intersect.glsl: never loses a child whose box, BOX_MARGIN cells inside its
// planes, the exact ray meets; finds few that are missed, and no absent one.
#include "shaders/shared/scene_types.h"
#include "tests/shaders/queries.h"
#include "tests/shaders/wide_node.hpp"
#include "tests/support/device_fixture.hpp"
#include "tests/support/test_shader.hpp"

#include "embedded/enter_children_shader.h"

#include <gtest/gtest.h>

#include <bit>
#include <cmath>

namespace stromboli::test {
namespace {

using gpu::NodeAnswer;
using gpu::NodeQuery;

NodeQuery query(const WideNode& node, const glm::vec3& origin, const glm::vec3& direction,
                float tMax = kInfinite) {
    NodeQuery q{};
    std::ranges::copy(node.words(), q.record);
    q.origin = origin;
    q.tMax = tMax;
    q.direction = direction;
    return q;
}

/// Where the line is within the box; near > far: nowhere.
struct Interval {
    double near = 0, far = INFINITY;
};

Interval truth(const DoubleBox& box, const NodeQuery& q) {
    Interval at;
    for (int i = 0; i < 3; ++i) {
        const double o = q.origin[i], d = q.direction[i];
        if (d == 0 && (o < box.low[i] || o > box.high[i])) return {0, -1};
        if (d == 0) continue;
        const double a = (box.low[i] - o) / d, b = (box.high[i] - o) / d;
        at.near = std::max(at.near, std::min(a, b));
        at.far = std::min(at.far, std::max(a, b));
    }
    return at;
}

/// Bit (slot) for each child that the kernel enters.
uint32_t enteredSlots(const NodeAnswer& a) {
    uint32_t slots = 0;
    for (uint32_t slot = 0; slot < 8; ++slot)
        slots |= (a.entered >> (slot ^ a.octant) & 1) << slot;
    return slots;
}

/// Rays at a child's box, `inwards` cells inside its planes: at corners, edges and faces.
glm::vec3 pointOf(const DoubleBox& box, Random& random) {
    glm::dvec3 p;
    for (int axis = 0; axis < 3; ++axis) {
        const uint32_t where = random.below(3);
        p[axis] = where == 0   ? box.low[axis]
                  : where == 1 ? box.high[axis]
                               : 0.5 * (box.low[axis] + box.high[axis]);
    }
    return glm::vec3(p);
}

/// From nearby, from within the node, from a plane of a box; three in eight with zeros of either
/// sign in the direction.
NodeQuery randomRay(const WideNode& node, float size, float distance, bool unit, Random& random) {
    uint32_t slot = random.below(8);
    while (node.present() != 0 && !node.has(slot))
        slot = random.below(8);
    const double inwards = random.below(2) ? gpu::BOX_MARGIN : 0;
    const DoubleBox box = node.box(slot, inwards);
    const glm::vec3 target = pointOf(box, random);
    glm::vec3 origin = target + size * distance * random.vector();
    if (random.below(4) == 0) origin = pointOf(box, random);
    glm::vec3 direction = target - origin;
    for (int axis = 0; axis < 3; ++axis)
        if (random.below(8) == 0) {
            origin[axis] = target[axis];
            direction[axis] = random.below(2) ? 0.0f : -0.0f;
        }
    if (direction == glm::vec3(0.0f)) direction = size * random.vector();
    const float largest =
        std::max({std::abs(direction.x), std::abs(direction.y), std::abs(direction.z)});
    if (unit) direction = glm::normalize(direction / largest);
    return query(node, origin, direction);
}

struct Counts {
    uint64_t met = 0, lost = 0, lostWithoutMargin = 0, lostByNearest = 0, lostNaively = 0;
    uint64_t passed = 0, foundWrongly = 0, absentFound = 0;
};

class EnterChildren : public DeviceTest {
  protected:
    struct Cases {
        std::vector<WideNode> nodes;
        std::vector<NodeQuery> queries;
        void add(const WideNode& node, const NodeQuery& q) {
            nodes.push_back(node);
            queries.push_back(q);
        }
    };

    static std::vector<NodeAnswer> answers(const std::vector<NodeQuery>& queries) {
        return ask<NodeAnswer>(enter_children_shader, queries);
    }

    static Counts count(const Cases& cases) {
        const std::vector<NodeAnswer> found = answers(cases.queries);
        Counts c;
        for (size_t i = 0; i < found.size(); ++i) {
            const uint32_t entered = enteredSlots(found[i]);
            c.absentFound += (entered & ~cases.nodes[i].present()) != 0;
            for (uint32_t slot = 0; slot < 8; ++slot)
                if (cases.nodes[i].has(slot))
                    countChild(cases.nodes[i], slot, cases.queries[i], (entered >> slot & 1) != 0,
                               (found[i].naive >> slot & 1) != 0, c);
        }
        return c;
    }

  private:
    static bool meets(const WideNode& node, uint32_t slot, double inwards, const NodeQuery& q) {
        const Interval at = truth(node.box(slot, inwards), q);
        return at.near <= at.far && at.near <= q.tMax;
    }

    static void countChild(const WideNode& node, uint32_t slot, const NodeQuery& q, bool entered,
                           bool naive, Counts& c) {
        const Interval outer = truth(node.box(slot, -double(gpu::BOX_MARGIN)), q);
        if (meets(node, slot, gpu::BOX_MARGIN, q)) {
            ++c.met;
            c.lost += !entered;
        } else if (outer.near > std::min(outer.far, double(q.tMax)) * (1 + 100 * kRoundoff)) {
            ++c.passed; // BOX_SLACK is 64 of these
            c.foundWrongly += entered;
        }
        c.lostWithoutMargin += meets(node, slot, 0, q) && !entered;
        c.lostByNearest += meets(node, slot, -0.5, q) && !entered;
        c.lostNaively += meets(node, slot, 0, q) && !naive;
    }
};

TEST_F(EnterChildren, LosesNoneThatTheExactRayMeetsAtAnyScale) {
    Random random(51);
    Counts all;
    for (const float size : {1e-30f, 1e-15f, 1e-3f, 1.0f, 1e6f, 1e17f}) {
        Cases cases;
        for (int i = 0; i < 30000; ++i) {
            const WideNode node = randomNode(size, random.below(2) ? 0.5f : 5.0f, random);
            // Directions as short as docs/theory/numerics.md allows coordinates to be.
            const bool unit = size < 1e-15f || random.below(2) == 0;
            cases.add(node, randomRay(node, size, 3, unit, random));
        }
        const Counts c = count(cases);
        EXPECT_EQ(c.lost, 0u) << size;
        EXPECT_EQ(c.foundWrongly, 0u) << size << ": the slack is wider than it need be";
        EXPECT_EQ(c.absentFound, 0u) << size;
        EXPECT_GT(c.met, 30000u) << size;
        EXPECT_GT(c.passed, 10000u) << size;
        EXPECT_GT(c.lostByNearest, 1000u)
            << "negative control: planes rounded to the nearest, half a cell off";
        all.lostWithoutMargin += c.lostWithoutMargin;
        all.lostNaively += c.lostNaively;
    }
    EXPECT_GT(all.lostWithoutMargin, 20u) << "negative control: boxes up to their very planes";
    EXPECT_GT(all.lostNaively, 20u) << "negative control: the slab test without slack";
}

/// Origins up to 1e7 node sizes away, nodes up to 1e5 of their sizes from the coordinates'
/// origin: rays that are aimed at a child meet the node or pass it by a few roundings. From where a
/// node is smaller than the slack, rays enter absent children too (host/bvh/node_record.hpp).
TEST_F(EnterChildren, LosesNoneFromAfar) {
    Random random(52);
    for (const float distance : {1e3f, 1e5f, 1e7f}) {
        Cases cases;
        for (int i = 0; i < 30000; ++i) {
            const WideNode node = randomNode(1, random.below(2) ? 0.5f : 1e2f, random);
            cases.add(node, randomRay(node, 1, distance, i % 2 == 0, random));
        }
        const Counts c = count(cases);
        EXPECT_EQ(c.lost, 0u) << distance;
        EXPECT_EQ(c.foundWrongly, 0u) << distance;
        EXPECT_GT(c.met, 3000u) << distance;
    }
}

/// A primitive's own distance may be off by 37 roundings: what is found at tMax stays in reach.
TEST_F(EnterChildren, EntersABoxThatBeginsAtTheClosestHit) {
    Random random(53);
    std::vector<NodeQuery> queries;
    std::vector<uint32_t> slots;
    while (queries.size() < 50000) {
        const WideNode node = randomNode(1, 3, random);
        NodeQuery q = randomRay(node, 1, 3, random.below(2) == 0, random);
        for (uint32_t slot = 0; slot < 8; ++slot) {
            if (!node.has(slot)) continue;
            const Interval at = truth(node.box(slot, gpu::BOX_MARGIN), q);
            if (!(at.near <= at.far) || at.near == 0) continue;
            q.tMax = float(at.near * (1 - 37 * kRoundoff));
            queries.push_back(q);
            slots.push_back(slot);
        }
    }
    const std::vector<NodeAnswer> found = answers(queries);
    for (size_t i = 0; i < found.size(); ++i)
        ASSERT_TRUE(enteredSlots(found[i]) >> slots[i] & 1) << i;
}

TEST_F(EnterChildren, RespectsTheInterval) {
    WideNode node({-8, -8, -8}, {-4, -4, -4});          // planes 1/16 apart
    node.addChild(5, {112, 112, 160}, {144, 144, 176}); // -1..1, -1..1, 2..3
    struct Case {
        glm::vec3 origin;
        float tMax;
        bool enters;
    };
    const float edge = 1 - gpu::BOX_MARGIN / 16; // where a box may begin
    const Case cases[] = {
        {{0, 0, 0}, 10, true},       {{0, 0, 0}, 2, true},         {{0, 0, 0}, 1.99f, false},
        {{0, 0, 2.5f}, 10, true},    {{0, 0, 3}, 10, true},        {{0, 0, 3.1f}, 10, false},
        {{1.1f, 0, 0}, 10, false},   {{-1.1f, 0, 0}, 10, false},   {{0, 1.1f, 0}, 10, false},
        {{edge, edge, 0}, 10, true}, {{-edge, -edge, 0}, 10, true}};
    std::vector<NodeQuery> queries;
    for (const Case& c : cases)
        queries.push_back(query(node, c.origin, {0, 0, 1}, c.tMax));
    const std::vector<NodeAnswer> found = answers(queries);
    for (size_t i = 0; i < queries.size(); ++i)
        EXPECT_EQ(enteredSlots(found[i]), cases[i].enters ? 1u << 5 : 0u) << i;
}

/// The mask comes in the order of the ray's octant, whatever children there are.
TEST_F(EnterChildren, OrdersTheMaskByOctant) {
    std::vector<NodeQuery> queries;
    for (uint32_t mask = 0; mask < 256; ++mask)
        for (uint32_t octant = 0; octant < 8; ++octant) {
            WideNode node({-1, -1, -1}, {-7, -7, -7});
            for (uint32_t slot = 0; slot < 8; ++slot)
                if (mask >> slot & 1) node.addChild(slot, glm::uvec3(0), glm::uvec3(255));
            const glm::vec3 direction(octant & 1 ? 1 : -1, octant & 2 ? 1 : -1,
                                      octant & 4 ? 1 : -1);
            queries.push_back(query(node, -3.0f * direction, direction));
        }
    const std::vector<NodeAnswer> found = answers(queries);
    for (size_t i = 0; i < queries.size(); ++i) {
        const uint32_t mask = uint32_t(i) / 8, octant = uint32_t(i) % 8;
        uint32_t expected = 0;
        for (uint32_t slot = 0; slot < 8; ++slot)
            if (mask >> slot & 1) expected |= 1u << (slot ^ octant);
        ASSERT_EQ(found[i].octant, octant) << i;
        ASSERT_EQ(found[i].entered, expected) << "mask " << mask << ", octant " << octant;
    }
}

TEST_F(EnterChildren, HighestBitOfEveryMask) {
    std::vector<NodeQuery> queries(255);
    for (uint32_t i = 0; i < 255; ++i)
        queries[i].number = i + 1;
    const std::vector<NodeAnswer> found = answers(queries);
    for (uint32_t i = 0; i < 255; ++i)
        EXPECT_EQ(found[i].highest, uint32_t(std::bit_width(i + 1)) - 1) << i + 1;
}

} // namespace
} // namespace stromboli::test
