#include "host/reference/bvh.hpp"
#include "host/reference/sampling.hpp"
#include "host/reference/surface.hpp"
#include "tests/analytic/scenes.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli::reference {
namespace {

using test::SceneMaker;

glm::dvec3 pointIn(RandomStream& random, double size) {
    const double x = random.next(), y = random.next(), z = random.next();
    return size * (2.0 * glm::dvec3(x, y, z) - 1.0);
}

Ray rayFrom(const glm::dvec3& origin, RandomStream& random) {
    const double u = random.next(), v = random.next();
    return {origin, uniformSphere(u, v)};
}

Hit bruteForce(const Scene& scene, const Ray& ray, Skip skip) {
    Hit best;
    const auto consider = [&](std::optional<Hit> hit, size_t primitive) {
        if (!hit || hit->t >= best.t || skip(uint32_t(primitive))) return;
        best = *hit;
        best.primitive = uint32_t(primitive);
    };
    for (size_t i = 0; i < scene.triangles.size(); ++i) {
        const uint32_t* c = scene.triangles[i].corner;
        consider(intersectTriangle(ray, scene.positions[c[0]], scene.positions[c[1]],
                                   scene.positions[c[2]]),
                 i);
    }
    for (size_t i = 0; i < scene.spheres.size(); ++i)
        consider(intersectSphere(ray, scene.spheres[i].center, scene.spheres[i].radius),
                 scene.triangles.size() + i);
    return best;
}

/// Small triangles and spheres in a cube; `equal`: all triangles the same.
Scene soup(uint32_t count, bool equal) {
    SceneMaker b;
    b.add(test::diffuse(0.5f));
    RandomStream random(count, 0, 5);
    glm::dvec3 corner = pointIn(random, 1);
    for (uint32_t i = 0; i < count; ++i) {
        if (!equal) corner = pointIn(random, 1);
        if (!equal && i % 4 == 3) {
            b.sphere(corner, float(0.01 + 0.2 * random.next()), 0);
            continue;
        }
        const glm::dvec3 e = equal ? glm::dvec3(0.5, 0, 0) : pointIn(random, 0.3);
        const glm::dvec3 f = equal ? glm::dvec3(0, 0.5, 0) : pointIn(random, 0.3);
        b.triangle(corner, corner + e, corner + f, 0);
    }
    return b.scene;
}

TEST(ReferenceBvh, FindsWhatBruteForceFinds) {
    for (uint32_t count : {0u, 1u, 2u, 5u, 37u, 400u}) {
        const Scene scene = soup(count, false);
        const Bvh bvh(scene);
        RandomStream random(0, count, 6);
        uint64_t hits = 0;
        for (int i = 0; i < 2000; ++i) {
            Ray ray = rayFrom(pointIn(random, 1.5), random);
            if (i % 3 == 0) ray.direction = {0, i % 2 == 0 ? 1 : -1, 0};
            const Skip skip{uint32_t(i) % (count + 1)};
            const Hit expected = bruteForce(scene, ray, skip), found = bvh.closest(ray, skip);
            EXPECT_EQ(found.primitive, expected.primitive);
            EXPECT_EQ(found.t, expected.t);
            EXPECT_EQ(bvh.occluded(ray, skip), expected.primitive != kNoPrimitive);
            if (expected.primitive == kNoPrimitive) continue;
            ++hits;
            ray.tMax = expected.t; // the end of a ray is not part of it
            EXPECT_FALSE(bvh.occluded(ray, skip));
        }
        if (count > 100) {
            EXPECT_GT(hits, 200u);
        }
    }
}

TEST(ReferenceBvh, ManyEqualPrimitives) {
    const Scene scene = soup(10000, true);
    const Bvh bvh(scene);
    const glm::dvec3 corner = scene.positions[0];
    const Ray ray{corner + glm::dvec3(0.1, 0.1, 2), {0, 0, -1}};
    EXPECT_NEAR(bvh.closest(ray, {}).t, 2, 1e-12);
}

TEST(ReferenceIntersect, TrianglesOfAnySize) {
    for (double size : {1e-12, 1.0, 1e12}) {
        const glm::dvec3 a(0, 0, 0), b(size, 0, 0), c(0, size, 0);
        const Ray ray{{0.25 * size, 0.25 * size, size}, {0, 0, -1}};
        const auto hit = intersectTriangle(ray, a, b, c);
        ASSERT_TRUE(hit);
        EXPECT_NEAR(hit->t / size, 1, 1e-14);
        EXPECT_NEAR(hit->b1, 0.25, 1e-14);
        EXPECT_NEAR(hit->b2, 0.25, 1e-14);
        EXPECT_TRUE(intersectTriangle(ray, a, c, b)) << "from behind";
    }
    EXPECT_FALSE(intersectTriangle({{0, 0, 1}, {0, 0, -1}}, {0, 0, 0}, {0, 0, 0}, {0, 0, 0}));
    EXPECT_FALSE(intersectTriangle({{-1, 0, 0}, {1, 0, 0}}, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}))
        << "within the plane";
}

TEST(ReferenceIntersect, SphereFromOutsideInsideAndFar) {
    const Ray outside{{0, 0, 3}, {0, 0, -1}}, inside{{0, 0, 0.5}, {0, 0, -1}};
    EXPECT_NEAR(intersectSphere(outside, {0, 0, 0}, 1)->t, 2, 1e-14);
    EXPECT_NEAR(intersectSphere(inside, {0, 0, 0}, 1)->t, 1.5, 1e-14);
    EXPECT_FALSE(intersectSphere({{0, 0, 3}, {0, 0, 1}}, {0, 0, 0}, 1));
    const Ray far{{0.9, 0, 1e9}, {0, 0, -1}};
    EXPECT_NEAR(intersectSphere(far, {0, 0, 0}, 1)->t, 1e9 - std::sqrt(0.19), 1e-6);
    EXPECT_FALSE(intersectSphere({{1.001, 0, 1e9}, {0, 0, -1}}, {0, 0, 0}, 1));
}

/// Rays that leave a surface must not meet it again, nor a second surface in the same place, at any
/// scale and far from the origin.
TEST(ReferenceSurface, RaysLeaveTheSurfaceTheyStartOn) {
    for (double scale : {1e-6, 1.0, 1e6})
        for (double shift : {0.0, 1e4}) {
            SceneMaker b;
            b.add(test::diffuse(0.5f));
            const auto at = [&](double x, double y, double z) {
                return glm::vec3(scale * (glm::dvec3(x, y, z) + shift));
            };
            const glm::vec3 v0 = at(0.1, 0.2, 0.3), v1 = at(1.2, 0.4, 0), v2 = at(0.3, 1.7, 0.9);
            b.triangle(v0, v1, v2, 0);
            b.triangle(v0, v1, v2, 0);
            b.triangle(v1, v2, v0, 0);
            b.sphere(at(0, 0, 5), float(scale), 0);
            b.sphere(at(0, 0, 5), float(scale), 0);
            const Bvh bvh(b.scene);
            RandomStream random(1, uint32_t(shift), 7);
            for (int i = 0; i < 20000; ++i) {
                const double u = random.next(), v = random.next();
                const glm::dvec2 w = uniformTriangle(u, v);
                const glm::dvec3 p =
                    (1 - w.x - w.y) * glm::dvec3(v0) + w.x * glm::dvec3(v1) + w.y * glm::dvec3(v2);
                const glm::dvec3 aim =
                    i % 2 == 0 ? p : glm::dvec3(at(0, 0, 5)) + 0.9 * scale * uniformSphere(u, v);
                Ray ray = rayFrom({}, random);
                ray.origin = aim - 9 * scale * ray.direction;
                const Hit hit = bvh.closest(ray, {});
                if (hit.primitive == kNoPrimitive) continue;
                const SurfacePoint s = surfaceAt(b.scene, ray, hit);
                const Ray out = rayFrom({}, random);
                const Ray leaving{moveOff(s.position, s.error, s.geometric, out.direction),
                                  out.direction};
                const Hit next = bvh.closest(leaving, {s.triangle});
                if (next.primitive == kNoPrimitive) continue;
                const bool sphere = hit.primitive >= 3;
                if (sphere && next.primitive >= 3) {
                    // Only through the inside: the chord.
                    EXPECT_LT(glm::dot(out.direction, s.geometric), 0);
                    EXPECT_NEAR(next.t / scale, -2 * glm::dot(out.direction, s.geometric),
                                1e-6 + 1e-9 * shift);
                } else {
                    EXPECT_NE(next.primitive >= 3, sphere);
                }
            }
        }
}

TEST(ReferenceSurface, NormalsFaceTheViewer) {
    SceneMaker b;
    b.add(test::diffuse(0.5f));
    b.triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, 0);
    b.scene.normals = {{0, 0, 1}, {0.6f, 0, 0.8f}, {0, 0, 1}};
    for (uint32_t i = 0; i < 3; ++i)
        b.scene.triangles[0].normals[i] = i;
    for (double side : {1.0, -1.0}) {
        const Ray ray{{0.2, 0.3, side}, {0, 0, -side}};
        const Hit hit = Bvh(b.scene).closest(ray, {});
        SurfacePoint s = surfaceAt(b.scene, ray, hit);
        const glm::dvec3 n = glm::normalize(glm::dvec3(0.2 * 0.6, 0, 0.8 + 0.2 * 0.8));
        EXPECT_NEAR(glm::distance(s.shading, n), 0, 1e-7);
        EXPECT_EQ(s.outside, side > 0);
        SurfacePoint unflipped = s;
        faceForward(unflipped, {.facesForward = false});
        EXPECT_EQ(unflipped.shading, s.shading);
        faceForward(s, {});
        EXPECT_NEAR(glm::distance(s.shading, side * n), 0, 1e-7);
        EXPECT_NEAR(glm::distance(s.geometric, {0, 0, side}), 0, 1e-7);

        s.wo = glm::normalize(glm::dvec3(-1, 0, side * 1e-3)); // below the shading horizon
        faceForward(s, {});
        s.outside = true;
        EXPECT_NEAR(std::abs(s.shading.z), 1, 1e-7);
    }
}

TEST(ReferenceSampling, FramesAreOrthonormal) {
    RandomStream random(0, 0, 8);
    for (int i = 0; i < 1000; ++i) {
        const double u = random.next(), v = random.next();
        const glm::dvec3 z = i < 3 ? glm::dvec3(i == 0, i == 1, i == 2) : uniformSphere(u, v);
        const Frame f(z);
        EXPECT_NEAR(glm::dot(f.x, f.y), 0, 1e-12);
        EXPECT_NEAR(glm::distance(glm::cross(f.x, f.y), z), 0, 1e-12);
        EXPECT_NEAR(glm::length(f.x), 1, 1e-12);
    }
}

} // namespace
} // namespace stromboli::reference
