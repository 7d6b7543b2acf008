// How high the smooth surface is over a triangle: against spheres, Hanika's sum, and normals that
// say nothing of a surface.
#include "host/reference/surface.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <random>

namespace stromboli::reference {
namespace {

class SmoothTriangles : public testing::Test {
  protected:
    std::mt19937 generator{17};
    std::uniform_real_distribution<double> uniform;

    glm::dvec3 direction() {
        std::normal_distribution<double> normal;
        return glm::normalize(glm::dvec3(normal(generator), normal(generator), normal(generator)));
    }

    /// Uniform on the triangle.
    glm::dvec3 weights() {
        const double r = std::sqrt(uniform(generator)), s = uniform(generator);
        return {1 - r, r * (1 - s), r * s};
    }
};

glm::dvec3 faceNormal(const SmoothTriangle& t) {
    return triangleNormal(t.corner[0], t.corner[1], t.corner[2]);
}

glm::dvec3 sum(const glm::dvec3& weights, const glm::dvec3 (&values)[3]) {
    return weights[0] * values[0] + weights[1] * values[1] + weights[2] * values[2];
}

/// A triangle with corners on a sphere about the origin, and its normals; seen from outside.
struct OnSphere {
    SmoothTriangle triangle;
    glm::dvec3 front;
    double circumradius; ///< angle, radians

    OnSphere(double radius, const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
        : triangle{{radius * a, radius * b, radius * c}, {a, b, c}}, front(faceNormal(triangle)) {
        if (glm::dot(front, a) < 0) front = -front;
        circumradius = std::acos(glm::dot(front, a));
    }
};

/// The plane through the lifted point across the shading normal does not touch the sphere: no
/// direction above the horizon meets the mesh within. True while the triangles span 60 degrees or
/// less from their middle (docs/theory/numerics.md), and shown to end there.
TEST_F(SmoothTriangles, LiftedPointsSeeOverASphere) {
    int small = 0, large = 0, under = 0;
    for (int i = 0; i < 200000; ++i) {
        const double radius = 3.5;
        const OnSphere s(radius, direction(), direction(), direction());
        const glm::dvec3 b = weights(), p = sum(b, s.triangle.corner);
        const glm::dvec3 lifted = p + s.triangle.height(b, s.front) * s.front;
        const double horizon = glm::dot(glm::normalize(sum(b, s.triangle.normal)), lifted);
        if (s.circumradius > 1.0472) {
            ++large;
            under += horizon < radius * (1 - 1e-9);
            continue;
        }
        ++small;
        ASSERT_GE(horizon, radius * (1 - 1e-12)) << s.circumradius;
    }
    EXPECT_GT(small, 50000);
    EXPECT_GT(under, large / 100);
}

/// On a sphere the height is known: (R^2 - |p|^2) / R, twice what p lacks to it, for small facets.
TEST_F(SmoothTriangles, HeightOnASphere) {
    for (int i = 0; i < 1000; ++i) {
        const OnSphere s(2, direction(), direction(), direction());
        if (s.circumradius > 1.5) continue;
        const glm::dvec3 b = weights(), p = sum(b, s.triangle.corner);
        EXPECT_NEAR(s.triangle.height(b, s.front), (4 - glm::dot(p, p)) / 2, 1e-12);
        // Seen from inside, the surface is behind.
        EXPECT_EQ(s.triangle.height(b, -s.front), 0);
    }
}

/// Hanika 2021: the point is moved along each corner's normal by what it lacks to the tangent plane
/// there, times its weight. Where it lacks something at every corner, the lengths add up to our
/// height.
TEST_F(SmoothTriangles, HeightIsHanikasWhereAllCornersAreHigher) {
    int compared = 0;
    for (int i = 0; i < 20000; ++i) {
        SmoothTriangle t{{direction(), direction(), direction()}, {}};
        const glm::dvec3 front = faceNormal(t);
        for (glm::dvec3& n : t.normal)
            n = glm::normalize(front + 0.7 * direction());
        const glm::dvec3 b = weights(), p = sum(b, t.corner);
        double hanika = 0;
        bool allHigher = true;
        for (int c = 0; c < 3; ++c) {
            const double lacks = -glm::dot(p - t.corner[c], t.normal[c]);
            hanika += b[c] * lacks;
            allHigher &= lacks > 0;
        }
        for (int c = 0; c < 3; ++c) {
            const int d = (c + 1) % 3;
            allHigher &= glm::dot(t.normal[c] - t.normal[d], t.corner[c] - t.corner[d]) > 0;
        }
        if (!allHigher) continue;
        ++compared;
        EXPECT_NEAR(t.height(b, front), hanika, 1e-12);
    }
    EXPECT_GT(compared, 500);
}

/// Tilted but parallel normals, as of a flat wall with wrong ones: Hanika's clamp at each corner
/// would lift the point, and let it look over the wall's edge.
TEST_F(SmoothTriangles, ParallelNormalsDoNotLift) {
    for (int i = 0; i < 1000; ++i) {
        const glm::dvec3 n = direction(), b = weights();
        const SmoothTriangle t{{direction(), direction(), direction()}, {n, n, n}};
        const glm::dvec3 front = faceNormal(t), p = sum(b, t.corner);
        EXPECT_EQ(t.height(b, front), 0);
        EXPECT_EQ(t.height(b, -front), 0);
        double hanika = 0;
        for (int c = 0; c < 3; ++c)
            hanika += b[c] * std::max(-glm::dot(p - t.corner[c], n), 0.0);
        EXPECT_GT(hanika, 0) << "negative control";
    }
}

TEST_F(SmoothTriangles, NormalsOnBothSidesOrInThePlaneDoNotLift) {
    const glm::dvec3 up(0, 0, 1), level(1, 0, 0);
    const glm::dvec3 b(0.3, 0.3, 0.4);
    for (const glm::dvec3& odd : {level, -up, glm::normalize(glm::dvec3(1, 0, -0.01))}) {
        const SmoothTriangle t{{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {up, odd, up}};
        EXPECT_EQ(t.height(b, up), 0);
        EXPECT_EQ(t.height(b, -up), 0);
    }
}

TEST_F(SmoothTriangles, HeightScalesAndMindsNotTheSignOfNormals) {
    for (int i = 0; i < 1000; ++i) {
        const OnSphere s(1, direction(), direction(), direction());
        if (s.circumradius > 1.5) continue;
        const glm::dvec3 b = weights();
        SmoothTriangle other = s.triangle;
        for (int c = 0; c < 3; ++c)
            other.corner[c] *= 0x1p-70, other.normal[c] = -other.normal[c];
        EXPECT_EQ(other.height(b, s.front), 0x1p-70 * s.triangle.height(b, s.front));
    }
}

} // namespace
} // namespace stromboli::reference
