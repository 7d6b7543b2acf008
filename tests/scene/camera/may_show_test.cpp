// Whether a camera can see anything of a scene.

#include "scene/camera/camera.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace stromboli::test {
namespace {

Scene withTriangle(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    Scene scene;
    scene.positions = {a, b, c};
    Triangle t;
    for (uint32_t i = 0; i < 3; ++i)
        t.corner[i] = i;
    scene.triangles = {t};
    return scene;
}

Scene withSphere(const glm::vec3& center, float radius) {
    Scene scene;
    scene.spheres = {{.center = center, .radius = radius}};
    return scene;
}

/// A small triangle about a point.
Scene speck(const glm::vec3& at) {
    return withTriangle(at, at + glm::vec3(1e-3f, 0, 0), at + glm::vec3(0, 1e-3f, 0));
}

/// At the origin, looks along -z, sees 45 degrees to each side.
Camera camera() {
    Camera c;
    c.nearDistance = 1, c.farDistance = 10;
    return c;
}

TEST(MayShow, OnlyWhatIsInTheFieldOfViewAndTheDepthRange) {
    EXPECT_TRUE(mayShow(camera(), speck({0, 0, -5})));
    EXPECT_TRUE(mayShow(camera(), speck({4.9f, -4.9f, -5})));
    for (const glm::vec3& out :
         {glm::vec3(5.1f, 0, -5), glm::vec3(-5.1f, 0, -5), glm::vec3(0, 5.1f, -5),
          glm::vec3(0, -5.1f, -5), glm::vec3(0, 0, -0.9f), glm::vec3(0, 0, -10.1f),
          glm::vec3(0, 0, 5)})
        EXPECT_FALSE(mayShow(camera(), speck(out))) << out.x << ' ' << out.y << ' ' << out.z;
    EXPECT_FALSE(mayShow(camera(), Scene{}));
}

TEST(MayShow, OrthographicViewsDoNotWiden) {
    Camera c = camera();
    c.orthographic = true;
    c.halfWidth = 2, c.halfHeight = 1;
    EXPECT_TRUE(mayShow(c, speck({1.9f, 0.9f, -9})));
    EXPECT_FALSE(mayShow(c, speck({2.1f, 0, -9})));
    EXPECT_FALSE(mayShow(c, speck({0, -1.1f, -9})));
}

TEST(MayShow, AShiftedPictureHasOtherSides) {
    Camera c = camera();
    c.shift = {0.5, -2};
    EXPECT_TRUE(mayShow(c, speck({7.4f, -5.1f, -5})));
    EXPECT_TRUE(mayShow(c, speck({-2.4f, -14.9f, -5})));
    for (const glm::vec3& out : {glm::vec3(7.6f, -10, -5), glm::vec3(-2.6f, -10, -5),
                                 glm::vec3(0, -4.9f, -5), glm::vec3(0, -15.1f, -5)})
        EXPECT_FALSE(mayShow(c, speck(out))) << out.x << ' ' << out.y;
    // The plane on the left is x = -z / 2 there, 0.447 of 1 away for one unit across.
    EXPECT_TRUE(mayShow(c, withSphere({-3.5f, -10, -5}, 0.90f)));
    EXPECT_FALSE(mayShow(c, withSphere({-3.5f, -10, -5}, 0.89f)));
}

TEST(MayShow, SpheresHaveTheirRadius) {
    // The plane at 45 degrees is sqrt(1/2) of the way away.
    EXPECT_TRUE(mayShow(camera(), withSphere({6, 0, -5}, 0.71f)));
    EXPECT_FALSE(mayShow(camera(), withSphere({6, 0, -5}, 0.70f)));
    EXPECT_TRUE(mayShow(camera(), withSphere({0, 0, -11}, 1.01f)));
    EXPECT_FALSE(mayShow(camera(), withSphere({0, 0, -11}, 0.99f)));
}

TEST(MayShow, DepthAlongTheRayReachesLessFarAtTheCorners) {
    Camera c = camera();
    c.clipAlongRay = true;
    // The middle of the picture: both measures agree. Its corner is sqrt(3) times as far away.
    EXPECT_FALSE(mayShow(c, speck({0, 0, -0.5f})));
    EXPECT_TRUE(mayShow(c, speck({0.59f, 0.59f, -0.6f}))) << "1.02 along the ray";
    EXPECT_FALSE(mayShow(c, speck({0, 0, -10.1f})));
}

/// Sound: never false where a ray of the camera meets the triangle.
TEST(MayShow, IsTrueOfWhateverARayMeets) {
    std::mt19937 random(7);
    std::uniform_real_distribution<double> one(-1, 1), unit(0, 1);
    const auto point = [&](double size) {
        return glm::dvec3(one(random), one(random), one(random)) * size;
    };
    for (int i = 0; i < 20000; ++i) {
        Camera c = lookingAt(point(3), point(3), std::exp(2 * one(random)));
        c.halfHeight = c.halfWidth * std::exp(one(random));
        c.orthographic = i % 2 == 0;
        c.clipAlongRay = i % 3 == 0;
        if (!c.orthographic && i % 4 == 1) c.shift = {one(random) * 2, one(random) * 2};
        c.nearDistance = unit(random), c.farDistance = 5 + unit(random);
        // A point on a ray within the range of depths, and a triangle that has it inside.
        const glm::dvec3 offset = (one(random) * c.halfWidth + c.shift.x) * c.right +
                                  (one(random) * c.halfHeight + c.shift.y) * c.up;
        const glm::dvec3 direction = c.orthographic ? -c.back : offset - c.back;
        const double depth = (c.nearDistance + (c.farDistance - c.nearDistance) * unit(random)) /
                             (c.clipAlongRay ? glm::length(direction) : 1);
        const glm::dvec3 hit =
            c.position + (c.orthographic ? offset : glm::dvec3(0)) + depth * direction;
        const glm::dvec3 a = point(10), b = point(10);
        const double u = 0.1 + 0.4 * unit(random), v = 0.1 + 0.4 * unit(random);
        const glm::dvec3 last = (hit - u * a - v * b) / (1 - u - v);
        EXPECT_TRUE(mayShow(c, withTriangle(a, b, last))) << i;
    }
}

} // namespace
} // namespace stromboli::test
