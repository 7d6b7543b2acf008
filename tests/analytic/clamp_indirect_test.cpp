// Light that is limited where it was scattered twice or more (--clamp-indirect): what is left of it
// has a closed form in a furnace, where each bounce of a path brings the same light.
#include "tests/analytic/scenes.hpp"

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

/// Of the k-th bounce 2^-k arrives, from the second one on no more than the limit.
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

} // namespace
} // namespace stromboli
