// Surfaces that lie in one another, at places where rounding has nothing to hold on to.
#include "tests/analytic/scenes.hpp"

#include <gtest/gtest.h>

namespace stromboli {
namespace {

using namespace test;

/// `copies` floors in the plane with this normal through `at`, and a point light over it.
Scene floors(int copies, const glm::vec3& at, const glm::vec3& edgeA, const glm::vec3& edgeB) {
    SceneMaker b;
    const uint32_t material = b.add(diffuse(0.5f));
    for (int i = 0; i < copies; ++i)
        b.quad(at - 0.5f * edgeA - 0.5f * edgeB, edgeA, edgeB, material);
    Light light;
    light.position = at + 3.0f * glm::normalize(glm::cross(edgeA, edgeB)) + 0.2f * edgeA;
    b.add(light);
    return b.scene;
}

/// A plane is not lit by itself, however often it is there: all light scattered twice would have
/// to go from it to it.
TEST(Coplanar, CopiesOfAFloorDoNotLightEachOther) {
    struct Plane {
        glm::vec3 at, edgeA, edgeB;
    };
    for (const Plane& p : {Plane{{0, 0, 0}, {0, 0, 2}, {2, 0, 0}},
                           {{0.3f, 0, -0.7f}, {0.1f, 0, 2}, {2, 0, 0.3f}},
                           {{5, -7, 11}, {0, 0, 2}, {2, 0, 0}},
                           {{5, -7, 11}, {1.3f, 0.2f, 1}, {-1, 0.7f, 1.1f}}}) {
        const Scene scene = floors(3, p.at, p.edgeA, p.edgeB);
        const glm::dvec3 normal = glm::normalize(glm::cross(p.edgeA, p.edgeB));
        const Camera camera =
            pointCamera(glm::dvec3(p.at) + 2.0 * normal + 0.5 * glm::dvec3(p.edgeB), p.at, 0.2);
        RenderSettings s = smallPicture(64, 3);
        s.estimator.minBounce = 2;
        expectMean(estimate(scene, camera, s), 0);
        s.estimator.minBounce = 1;
        s.estimator.maxBounces = 1;
        EXPECT_GT(estimate(scene, camera, s).mean.x, 0); // light does reach it
    }
}

} // namespace
} // namespace stromboli
