// Smooth dielectrics in a white furnace.
#include "tests/analytic/scenes.hpp"

#include <gtest/gtest.h>

namespace stromboli {
namespace {

using namespace test;

TEST(Glass, WhiteFurnaceIsOneInEverySample) {
    for (Roulette::Mode mode : {Roulette::Mode::None, Roulette::Mode::Throughput}) {
        RenderSettings s = smallPicture(64, 1000);
        s.estimator.roulette.mode = mode;
        const Estimate found = estimate(sphereInAmbientLight(glass(1.5f)), kOutside, s);
        if (mode == Roulette::Mode::None) {
            EXPECT_LT(found.error.x, kRounding);
        }
        expectMean(found, 1);
    }
}

TEST(Glass, RadianceInsideIsLargerByTheSquareOfTheIndex) {
    Material m = glass(1.5f);
    m.kind = MaterialKind::Refraction;
    const Camera center = pointCamera({0, 0, 0}, {0, 0, 1}, 0.5);
    for (MaterialKind kind : {MaterialKind::Refraction, MaterialKind::Dielectric}) {
        m.kind = kind;
        expectMean(estimate(sphereInAmbientLight(m), center, smallPicture(16, 1000)), 2.25);
    }
}

TEST(Glass, TransmittanceAndReflectanceColourTheLight) {
    Material m = glass(1.5f);
    m.transmittance = {1, 0.5f, 0};
    m.reflectance = {0, 0, 1};
    const Camera straight = pointCamera({0, 0, 4}, {0, 0, 0});
    const double r = 0.04; // ((1.5 - 1) / (1.5 + 1))^2, perpendicular
    // Through both faces; or off the first one. Red and green cannot be reflected.
    expectMean(estimate(sphereInAmbientLight(m), straight, smallPicture(64, 1000)),
               {(1 - r) * (1 - r), 0.25 * (1 - r) * (1 - r), r});
}

} // namespace
} // namespace stromboli
