#include "host/bvh/leaf_items.hpp"
#include "host/bvh/wide_layout.hpp"
#include "host/core/error.hpp"
#include "scene/generate/scene_maker.hpp"
#include "tests/bvh/fixtures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

namespace stromboli::test {
namespace {

/// Compares float `bound` with a + b exactly: the sign of bound - (a + b). __float128 has 113
/// bits, enough for sums of floats whose exponents differ by less than 89.
int compareWithSum(float bound, float a, float b) {
    const __float128 difference = __float128(bound) - (__float128(a) + __float128(b));
    return difference > 0 ? 1 : (difference < 0 ? -1 : 0);
}

TEST(PrimitiveBounds, CornersThatAreNotFiniteAreRefused) {
    for (const float bad :
         {std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()})
        for (size_t corner = 0; corner < 8; ++corner)
            for (int axis = 0; axis < 3; ++axis) {
                scenes::SceneMaker maker; // 12 triangles, which the leaves hold in pairs
                maker.box({-1, -2, -3}, {1, 2, 3}, maker.add(scenes::diffuse(0.5f)));
                ASSERT_NO_THROW(buildWideBvh(maker.scene));
                maker.scene.positions.at(corner)[axis] = bad;
                EXPECT_THROW(buildWideBvh(maker.scene), SceneError) << corner << ' ' << axis;
            }
}

TEST(PrimitiveBounds, TrianglesThenSpheres) {
    Random random(10);
    Scene scene = soup(5, 3, 0.3f, random);
    for (uint32_t i = 0; i < 5; ++i) {
        Bounds expected;
        for (const uint32_t corner : scene.triangles[i].corner)
            expected.extend(scene.positions[corner]);
        EXPECT_EQ(primitiveBounds(scene, i).lo, expected.lo);
        EXPECT_EQ(primitiveBounds(scene, i).hi, expected.hi);
    }
    for (uint32_t i = 0; i < 3; ++i)
        EXPECT_NEAR(glm::length(primitiveBounds(scene, 5 + i).extent()),
                    2 * std::sqrt(3.0f) * scene.spheres[i].radius, 1e-5f);
}

TEST(PrimitiveBounds, SphereLiesInsideItsBoxExactlyAndTightly) {
    constexpr float kInfinity = std::numeric_limits<float>::infinity();
    Random random(11);
    uint32_t roundedInward = 0;
    for (int i = 0; i < 20000; ++i) {
        Scene scene;
        Sphere s;
        s.center = random.inCube(1) * std::ldexp(1.0f, int(random.below(40)) - 20);
        s.radius = random.uniform(0.5f, 1.0f) * std::ldexp(1.0f, int(random.below(40)) - 20);
        scene.spheres.push_back(s);
        const Bounds b = primitiveBounds(scene, 0);
        for (int axis = 0; axis < 3; ++axis) {
            const float c = s.center[axis], r = s.radius;
            ASSERT_LE(compareWithSum(b.lo[axis], c, -r), 0);
            ASSERT_GE(compareWithSum(b.hi[axis], c, r), 0);
            // The next float inward is inside the sphere: no wider than it has to be.
            ASSERT_GT(compareWithSum(std::nextafter(b.lo[axis], kInfinity), c, -r), 0);
            ASSERT_LT(compareWithSum(std::nextafter(b.hi[axis], -kInfinity), c, r), 0);
            roundedInward += compareWithSum(c + r, c, r) < 0;
        }
    }
    EXPECT_GT(roundedInward, 10000u) << "plain centre + radius would do: the test is blunt";
}

} // namespace
} // namespace stromboli::test
