// Light that is limited where it was scattered twice or more (--clamp-indirect): what is left of it
// has a closed form in a furnace, where each bounce of a path brings the same light.
#include "tests/analytic/media.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace stromboli {
namespace {

using namespace test;

const glm::dvec3 kShine(1, 0.5, 0.25);

/// A closed box whose walls reflect one half and shine.
Scene shiningBox() {
    SceneMaker maker;
    Material wall = diffuse(0.5f, 1);
    wall.emission = glm::vec3(kShine);
    maker.box({-1, -1, -1}, {1, 1, 1}, maker.add(wall), true);
    return maker.scene;
}

/// The k-th bounce brings 2^-k, from the second one on no more than the limit.
double shareLeft(uint32_t bounces, double limit) {
    double sum = 0;
    for (uint32_t k = 0; k <= bounces; ++k) {
        const double arrives = std::pow(0.5, k);
        sum += k >= 2 && limit > 0 ? std::min(arrives, limit) : arrives;
    }
    return sum;
}

TEST(ClampIndirect, KeepsTheColourAndDropsTheRest) {
    for (const uint32_t branches : {1u, 4u})
        for (const double limit : {0.0, 0.01, 0.1, 0.2, 10.0}) {
            RenderSettings s = smallPicture(16 / branches, 8);
            s.estimator.branches = branches;
            s.estimator.directLight = DirectLight::Bsdf;
            s.estimator.indirectLimit = limit;
            expectMean(estimate(shiningBox(), kInside, s), kShine * shareLeft(8, limit));
        }
}

/// A lamp in a box: what light samples bring from the second surface on is limited, and what they
/// bring to the first one is not.
TEST(ClampIndirect, LimitsLightSamplesAfterTheFirstBounce) {
    constexpr double kLimit = 1e-3;
    SceneMaker maker;
    maker.box({-1, -1, -1}, {1, 1, 1}, maker.add(diffuse(0.5f)), true);
    maker.add(pointLight(1, {0.2f, 0.3f, 0.1f}));
    RenderSettings s = smallPicture(1, 4);
    s.estimator.indirectLimit = kLimit;
    uint32_t limited = 0, above = 0;
    for (uint32_t sample = 0; sample < 16; ++sample) {
        const RecordedPath path = recordedAlone(maker.scene, kInside, s, 0, sample);
        for (size_t v = 0; v < path.vertices.size(); ++v)
            for (const RecordedLight& light : path.vertices[v].lights) {
                const double most = std::max({light.light.x, light.light.y, light.light.z});
                if (v == 0) {
                    above += most > kLimit;
                } else {
                    EXPECT_LE(most, kLimit * (1 + 1e-6));
                    limited += most > kLimit * (1 - 1e-6);
                }
            }
        const glm::dvec3 sum = sumOf(path);
        EXPECT_NEAR(path.radiance.x, sum.x, 1e-5 * sum.x);
    }
    EXPECT_GT(limited, 0u);
    EXPECT_GT(above, 0u);
}

/// A ball of radius 1 in light from everywhere, of a medium that scatters all light, under glass
/// (ior 1: behind a border alone).
Scene whiteBall(bool isUnderSurface, float ior) {
    SceneMaker maker;
    maker.add(ambient(1));
    Medium milk = mediumOf(glm::vec3(0), glm::vec3(3), 0.3f);
    milk.isUnderSurface = isUnderSurface;
    const uint32_t inside = maker.add(milk);
    Material surface = ior == 1 ? border(inside) : glass(ior);
    surface.boundsMedia = true;
    surface.inside = inside;
    maker.sphere({0, 0, 0}, 1, maker.add(surface));
    return maker.scene;
}

/// Scatterings under a surface do not count: all light is of the first bounce.
TEST(ClampIndirect, CountsWalksUnderSurfacesAsOneBounce) {
    for (const uint32_t branches : {1u, 3u}) {
        RenderSettings s = smallPicture(36, 1);
        s.estimator.branches = branches;
        s.estimator.indirectLimit = 0.25;
        expectMean(estimate(whiteBall(true, 1.33f), pointCamera({0, 0.3, 3}, {0, 0.3, 0}), s), 1);
    }
}

/// In other media each scattering counts. A path brings 1, or the limit after two of them; with one
/// bounce at most only the others are seen, and all of them together bring 1, but for the backdrop.
TEST(ClampIndirect, CountsScatteringsInMedia) {
    constexpr double kLimit = 0.25;
    const Scene scene = whiteBall(false, 1);
    const Camera camera = pointCamera({0, 0.3, 3}, {0, 0.3, 0});
    RenderSettings s = smallPicture(128, 400);
    s.estimator.directLight = DirectLight::Bsdf;
    const Estimate all = estimate(scene, camera, s);
    s.estimator.indirectLimit = kLimit;
    const Estimate limited = estimate(scene, camera, s);
    s.estimator.maxBounces = 1;
    Estimate expected = estimate(scene, camera, s); // not limited: of one bounce
    expected.mean = (1 - kLimit) * expected.mean + kLimit * all.mean;
    expected.error += all.error;
    expectSameMean(limited, expected);
}

} // namespace
} // namespace stromboli
