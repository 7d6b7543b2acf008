#include "scene/build/orientation.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace stromboli::build {
namespace {

int sign(double x) {
    return (x > 0) - (x < 0);
}

TEST(Orientation, SimpleCases) {
    EXPECT_DOUBLE_EQ(orientation({0, 0}, {1, 0}, {0, 1}), 1);
    EXPECT_DOUBLE_EQ(orientation({0, 0}, {0, 1}, {1, 0}), -1);
    EXPECT_EQ(orientation({0, 0}, {1, 1}, {3, 3}), 0);
    EXPECT_EQ(orientation({1, 2}, {1, 2}, {5, 7}), 0);
}

TEST(Orientation, IsExactNearALine) {
    // Points of a grid of one ulp near (0.5, 0.5), against the line through (12, 12) and (24, 24):
    // the classical case in which plain arithmetic gets signs wrong. The true sign is that of y -
    // x.
    const double ulp = std::ldexp(1.0, -53);
    int plainMistakes = 0;
    for (int i = 0; i < 64; ++i)
        for (int j = 0; j < 64; ++j) {
            const glm::dvec2 a(0.5 + i * ulp, 0.5 + j * ulp), b(12, 12), c(24, 24);
            const int expected = sign(double(j - i));
            ASSERT_EQ(sign(orientation(b, c, a)), expected) << i << ' ' << j;
            ASSERT_EQ(sign(orientation(a, b, c)), expected);
            ASSERT_EQ(sign(orientation(b, a, c)), -expected);
            const double plain = (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
            plainMistakes += sign(plain) != expected;
        }
    EXPECT_GT(plainMistakes, 0) << "the case is not hard enough to show anything";
}

TEST(Orientation, AgreesWithIntegers) {
    std::mt19937 random(1);
    std::uniform_int_distribution<int64_t> coordinate(-(1 << 30), 1 << 30);
    for (int i = 0; i < 100000; ++i) {
        int64_t p[6];
        for (int64_t& x : p)
            x = i % 2 ? coordinate(random) : coordinate(random) >> 28;
        const auto exact =
            __int128(p[2] - p[0]) * (p[5] - p[1]) - __int128(p[3] - p[1]) * (p[4] - p[0]);
        const glm::dvec2 a(p[0], p[1]), b(p[2], p[3]), c(p[4], p[5]);
        ASSERT_EQ(sign(orientation(a, b, c)), (exact > 0) - (exact < 0));
    }
}

} // namespace
} // namespace stromboli::build
