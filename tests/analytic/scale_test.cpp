// A scene scaled as a whole, its radiances unchanged, makes the same picture: there is no length in
// the renderer.
#include "tests/analytic/scenes.hpp"
#include "tests/support/test_names.hpp"

#include <gtest/gtest.h>

namespace stromboli {
namespace {

using namespace test;

Scene scaled(Scene scene, float factor) {
    for (glm::vec3& p : scene.positions)
        p *= factor;
    for (Sphere& s : scene.spheres)
        s.center *= factor, s.radius *= factor;
    return scene;
}

Camera scaled(Camera camera, double factor) {
    camera.position *= factor;
    return camera;
}

class Scale : public testing::TestWithParam<float> {};

TEST_P(Scale, LeavesTheCornellBoxAsItIs) {
    const Scene scene = cornellBox();
    const glm::vec3 middle = 0.5f * (scene.bounds().lo + scene.bounds().hi);
    const Camera camera = pointCamera(glm::dvec3(middle) + glm::dvec3(0.1, 0.05, 0.4), middle, 0.6);
    for (DirectLight direct : kDirectLightModes) {
        RenderSettings s = smallPicture(256, 5);
        s.estimator.directLight = direct;
        const Estimate one = estimate(scene, camera, s);
        s.estimator.seed = 1;
        const Estimate other = estimate(scaled(scene, GetParam()), scaled(camera, GetParam()), s);
        EXPECT_GT(one.mean.x, 0);
        expectSameMean(other, one);
    }
}

// A small factor and one far beyond it each way: a length in the renderer shows the more, the
// further the scene is from it.
INSTANTIATE_TEST_SUITE_P(Factors, Scale, testing::Values(1e-12f, 1e-3f, 1e3f, 1e12f),
                         test::NamedByValue{});

} // namespace
} // namespace stromboli
