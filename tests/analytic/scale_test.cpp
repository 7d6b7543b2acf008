// A scene scaled as a whole, its radiances unchanged, makes the same picture: there is no length in
// the renderer.
#include "tests/analytic/scenes.hpp"

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

TEST(Scale, LeavesTheCornellBoxAsItIs) {
    const Scene scene = cornellBox();
    const glm::vec3 middle = 0.5f * (scene.bounds().lo + scene.bounds().hi);
    const Camera camera = pointCamera(glm::dvec3(middle) + glm::dvec3(0.1, 0.05, 0.4), middle, 0.6);
    for (const DirectLight direct : kDirectLightModes) {
        if (!isAnotherWay(direct)) continue;
        RenderSettings s = smallPicture(256, 5);
        s.estimator.directLight = direct;
        const Estimate one = estimate(scene, camera, s);
        s.estimator.seed = 1;
        EXPECT_GT(one.mean.x, 0);
        // A small factor and one far beyond it each way: a length in the renderer shows the more,
        // the further the scene is from it.
        for (const float factor : {1e-12f, 1e-3f, 1e3f, 1e12f}) {
            SCOPED_TRACE(factor);
            expectSameMean(estimate(scaled(scene, factor), scaled(camera, factor), s), one);
        }
    }
}

} // namespace
} // namespace stromboli
