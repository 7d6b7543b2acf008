#include "scene/build/orientation.hpp"
#include "scene/build/triangulate.hpp"
#include "tests/support/cpu_time.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>

namespace stromboli::build {
namespace {

using Triangles = std::vector<std::array<uint32_t, 3>>;
using Polygon = std::vector<glm::dvec2>;

std::vector<glm::dvec3> lifted(const Polygon& polygon) {
    std::vector<glm::dvec3> points;
    for (const glm::dvec2& p : polygon)
        points.emplace_back(p, 7.0);
    return points;
}

/// A triangulation: n - 2 triangles, each turning left, whose sides are the polygon's or meet
/// another triangle's, and whose areas add up to the polygon's.
void expectTriangulation(const Polygon& polygon, double tolerance = 1e-9) {
    Triangles triangles;
    EXPECT_TRUE(triangulate(lifted(polygon), triangles));
    const auto n = uint32_t(polygon.size());
    ASSERT_EQ(triangles.size(), n - 2);
    std::map<std::pair<uint32_t, uint32_t>, int> sides;
    double area = 0, sum = 0;
    for (uint32_t i = 0; i < n; ++i) {
        const glm::dvec2 &p = polygon[i], &q = polygon[(i + 1) % n];
        area += p.x * q.y - p.y * q.x;
        sides[{i, (i + 1) % n}] -= 1;
    }
    for (const auto& t : triangles) {
        const double twice = orientation(polygon[t[0]], polygon[t[1]], polygon[t[2]]);
        EXPECT_GT(twice, 0);
        sum += twice;
        for (int i = 0; i < 3; ++i) {
            sides[{t[i], t[(i + 1) % 3]}] += 1;
        }
    }
    EXPECT_NEAR(sum, area, tolerance * std::abs(area));
    for (const auto& [side, count] : sides) {
        const auto back = sides.find({side.second, side.first});
        const int reverse = back == sides.end() ? 0 : back->second;
        EXPECT_EQ(count, std::max(reverse, 0)) << side.first << ' ' << side.second;
    }
}

TEST(Triangulate, ConvexPolygonsAreFans) {
    Triangles triangles;
    EXPECT_TRUE(triangulate(lifted({{0, 0}, {2, 0}, {3, 1}, {2, 2}, {0, 2}}), triangles));
    EXPECT_EQ(triangles, (Triangles{{0, 1, 2}, {0, 2, 3}, {0, 3, 4}}));
}

TEST(Triangulate, ConcavePolygons) {
    expectTriangulation({{0, 0}, {4, 0}, {1, 1}, {0, 4}}); // arrow head
    expectTriangulation({{1, 1}, {0, 4}, {0, 0}, {4, 0}}); // the same
    expectTriangulation({{0, 0}, {3, 0}, {3, 3}, {2, 3}, {2, 1}, {1, 1}, {1, 3}, {0, 3}}); // U
    expectTriangulation({{0, 0}, {1, 0}, {1, 1}, {2, 1}, {2, 2}, {3, 2}, {3, 3}, {0, 3}}); // stairs
}

TEST(Triangulate, CornersOnStraightEdgesAreUsed) {
    expectTriangulation({{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {1, 2}, {0, 2}, {0, 1}});
    expectTriangulation({{0, 0}, {1, 0}, {2, 0}, {0, 2}});
    expectTriangulation({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}, {0, 1}});
    expectTriangulation({{0, 0}, {2, 0}, {2, 2}, {1, 1}, {0, 2}, {0, 1}});
}

TEST(Triangulate, HolesJoinedToTheOutline) {
    // A square with a square hole, joined by a slit that is walked twice: the usual export.
    expectTriangulation(
        {{0, 0}, {6, 0}, {6, 6}, {0, 6}, {0, 0}, {2, 2}, {2, 4}, {4, 4}, {4, 2}, {2, 2}});
}

TEST(Triangulate, AnyPlaneAndEitherSense) {
    const Polygon arrow{{0, 0}, {4, 0}, {1, 1}, {0, 4}};
    for (const glm::dvec3& u : {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(1, 2, 3)})
        for (const glm::dvec3& v : {glm::dvec3(0, 0, 1), glm::dvec3(-1, 1, 1)}) {
            std::vector<glm::dvec3> points;
            for (const glm::dvec2& p : arrow)
                points.push_back(p.x * u + p.y * v);
            Triangles triangles;
            EXPECT_TRUE(triangulate(points, triangles));
            ASSERT_EQ(triangles.size(), 2u);
            for (const auto& t : triangles) {
                const glm::dvec3 cross =
                    glm::cross(points[t[1]] - points[t[0]], points[t[2]] - points[t[0]]);
                EXPECT_GT(glm::dot(cross, glm::cross(u, v)), 0);
            }
        }
}

/// Corners around the origin at random distances: simple, and spiky.
Polygon randomStar(std::mt19937& random, int corners) {
    std::uniform_real_distribution<double> radius(0.05, 1);
    Polygon polygon;
    for (int i = 0; i < corners; ++i)
        polygon.push_back(radius(random) * glm::dvec2(std::cos(2 * M_PI * i / corners),
                                                      std::sin(2 * M_PI * i / corners)));
    return polygon;
}

TEST(Triangulate, RandomStars) {
    std::mt19937 random(2);
    for (int corners = 4; corners < 200; ++corners)
        expectTriangulation(randomStar(random, corners));
}

TEST(Triangulate, RandomStarsOnAGrid) {
    // Small integers: many corners on one line, some in one place.
    std::mt19937 random(3);
    for (int i = 0; i < 2000; ++i) {
        Polygon polygon = randomStar(random, 4 + i % 12);
        for (glm::dvec2& p : polygon)
            p = glm::round(p * 8.0);
        Triangles triangles;
        triangulate(lifted(polygon), triangles);
        EXPECT_EQ(triangles.size(), polygon.size() - 2);
    }
}

/// A spiral band: every triangle is far from fat, and nearly all corners of one side are reflex.
Polygon spiral(int corners) {
    Polygon outer, inner;
    for (int i = 0; i < corners / 2; ++i) {
        const double turn = 0.05 * i, radius = 1 + 0.1 * turn;
        const glm::dvec2 direction(std::cos(turn), std::sin(turn));
        outer.push_back((radius + 0.2) * direction);
        inner.push_back(radius * direction);
    }
    outer.insert(outer.end(), inner.rbegin(), inner.rend());
    return outer;
}

TEST(Triangulate, Spiral) {
    expectTriangulation(spiral(2000));
}

TEST(Triangulate, ManyCornersTakeNoQuadraticTime) {
    std::mt19937 random(4);
    const Polygon comb = [] {
        Polygon teeth{{0, -1}};
        for (int i = 0; i < 50000; ++i) {
            teeth.emplace_back(2 * i, 0);
            teeth.emplace_back(2 * i + 1, 1000);
        }
        teeth.emplace_back(100000, 0);
        teeth.emplace_back(100000, -1);
        std::reverse(teeth.begin(), teeth.end());
        return teeth;
    }();
    for (const Polygon& polygon : {spiral(100000), comb, randomStar(random, 100000)}) {
        const double before = test::cpuSeconds();
        Triangles triangles;
        EXPECT_TRUE(triangulate(lifted(polygon), triangles));
        EXPECT_EQ(triangles.size(), polygon.size() - 2);
        // Well below a second; testing each corner against each other takes minutes.
        EXPECT_LT(test::cpuSeconds() - before, 20);
    }
}

TEST(Triangulate, PolygonsThatAreNone) {
    const auto isSimple = [](const Polygon& polygon) {
        Triangles triangles;
        const bool simple = triangulate(lifted(polygon), triangles);
        EXPECT_EQ(triangles.size(), polygon.size() - 2);
        for (const auto& t : triangles)
            for (uint32_t corner : t)
                EXPECT_LT(corner, polygon.size());
        return simple;
    };
    EXPECT_FALSE(isSimple({{0, 0}, {1, 0}, {2, 0}, {3, 0}, {4, 0}})); // a line
    EXPECT_FALSE(isSimple({{1, 1}, {1, 1}, {1, 1}, {1, 1}, {1, 1}})); // a point
    isSimple({{0, 0}, {2, 2}, {2, 0}, {0, 2}});                       // a bow tie
    isSimple({{0, 3}, {2, -3}, {-3, 1}, {3, 1}, {-2, -3}});           // a pentagram
    isSimple({{1e300, 1e300}, {-1e300, 1e300}, {-1e300, -1e300}, {0, 0}, {1e300, -1e300}});
}

} // namespace
} // namespace stromboli::build
