// Rays and triangles in double precision: no gap and no overlap where triangles meet.
#include "scene/model/meet_triangle.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace stromboli {
namespace {

using TriangleCorners = std::array<glm::dvec3, 3>;

/// Numbers as scenes have them: of floats.
struct Numbers {
    std::mt19937 random{7};

    double within(double most) {
        return double(float(std::uniform_real_distribution<double>(-most, most)(random)));
    }
    glm::dvec3 point(double most) { return {within(most), within(most), within(most)}; }
};

size_t countMet(const glm::dvec3& origin, const glm::dvec3& to,
                const std::vector<TriangleCorners>& triangles) {
    size_t met = 0;
    for (const TriangleCorners& t : triangles)
        met += meetTriangle(origin, to - origin, t).has_value();
    return met;
}

/// Two triangles in one plane, on both sides of an edge of any direction.
TEST(MeetTriangle, OneOfTwoThatShareAnEdge) {
    Numbers numbers;
    for (int i = 0; i < 100'000; ++i) {
        const glm::dvec3 a = numbers.point(1), b = numbers.point(1);
        const glm::dvec3 middle = 0.5 * (a + b);
        const glm::dvec3 left = glm::dvec3(glm::vec3(middle + numbers.point(1)));
        const glm::dvec3 right = 2.0 * middle - left; // so that both lie in one plane
        const glm::dvec3 origin = numbers.point(5);
        const double share = 0.05 + 0.9 * std::abs(numbers.within(1));
        const std::vector<TriangleCorners> both = {{a, b, left}, {b, a, right}};
        EXPECT_EQ(countMet(origin, a + share * (b - a), both), 1u) << i;
        // In another order of corners and turned over, it is the same edge.
        const std::vector<TriangleCorners> turned = {{left, a, b}, {a, b, right}};
        EXPECT_EQ(countMet(origin, a + share * (b - a), turned), 1u) << i;
    }
}

/// Along the axes edges are met exactly.
TEST(MeetTriangle, OneOfThoseAroundACorner) {
    Numbers numbers;
    for (int i = 0; i < 2'000; ++i) {
        const int axis = i % 3;
        const size_t sides = 3 + size_t(i) % 6;
        std::vector<glm::dvec3> ring;
        for (size_t k = 0; k < sides; ++k) {
            const double angle = 6.283185307179586 * (double(k) + 0.3) / double(sides);
            glm::dvec3 p(numbers.within(0.5));
            p[(axis + 1) % 3] = double(float(std::cos(angle)));
            p[(axis + 2) % 3] = double(float(std::sin(angle)));
            ring.push_back(p);
        }
        std::vector<TriangleCorners> fan;
        for (size_t k = 0; k < sides; ++k)
            fan.push_back({glm::dvec3(0), ring[k], ring[(k + 1) % sides]});
        glm::dvec3 origin(0);
        origin[axis] = i % 2 == 0 ? 5 : -5;
        EXPECT_EQ(countMet(origin, glm::dvec3(0), fan), 1u) << i;
        EXPECT_EQ(countMet(origin, 0.25 * ring[0], fan), 1u) << i;
        EXPECT_EQ(countMet(glm::dvec3(numbers.within(0.1)) + origin, glm::dvec3(0), fan), 1u) << i;
    }
}

TEST(MeetTriangle, SaysWhereAndFromWhichSide) {
    Numbers numbers;
    for (int i = 0; i < 1'000; ++i) {
        const TriangleCorners c = {numbers.point(1), numbers.point(1), numbers.point(1)};
        const glm::dvec3 origin = numbers.point(5);
        const double u = 0.1 + 0.35 * std::abs(numbers.within(1));
        const double v = 0.1 + 0.35 * std::abs(numbers.within(1));
        const glm::dvec3 place = c[0] + u * (c[1] - c[0]) + v * (c[2] - c[0]);
        const glm::dvec3 normal = glm::cross(c[1] - c[0], c[2] - c[0]);
        // A third of the way there, and beyond.
        for (const double t : {3.0, -2.0}) {
            const auto met = meetTriangle(origin, (place - origin) / t, c);
            ASSERT_TRUE(met) << i;
            EXPECT_NEAR(met->t, t, 1e-9);
            EXPECT_NEAR(met->b1, u, 1e-7);
            EXPECT_NEAR(met->b2, v, 1e-7);
            EXPECT_EQ(met->fromFront, glm::dot((place - origin) / t, normal) < 0);
        }
        EXPECT_FALSE(meetTriangle(origin, c[0] - 0.1 * (place - c[0]) - origin, c)) << i;
    }
}

TEST(MeetTriangle, MeetsNothingWithoutAnArea) {
    const glm::dvec3 a(0), b(1, 0, 0), c(2, 0, 0), d(0, 1, 0);
    EXPECT_FALSE(meetTriangle({1, 0, 5}, {0, 0, -1}, {a, b, c}));
    EXPECT_FALSE(meetTriangle({0, 0, 5}, {0, 0, -1}, {a, a, a}));
    EXPECT_FALSE(meetTriangle({-5, 0.2, 0}, {1, 0, 0}, {a, b, d})) << "seen from its edge";
    EXPECT_FALSE(meetTriangle({0.2, 0.2, 5}, {0, 0, 0}, {a, b, d})) << "no ray";
    EXPECT_TRUE(meetTriangle({0.2, 0.2, 5}, {0, 0, -1}, {a, b, d}));
}

} // namespace
} // namespace stromboli
