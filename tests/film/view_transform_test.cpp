// Curves from radiance to the light of a screen, against their published formulas.
#include "host/film/view_transform.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

namespace stromboli {
namespace {

constexpr View kViews[] = {View::Standard, View::AgX, View::Filmic, View::PbrNeutral};

glm::dvec3 ofGrey(View view, double radiance) {
    return displayLight(view, glm::dvec3(radiance));
}

void expectNear(const glm::dvec3& found, const glm::dvec3& expected, double tolerance) {
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found[c], expected[c], tolerance) << "channel " << c;
}

// --- Each curve ----------------------------------------------------------------------------------

TEST(ViewStandard, CutsOff) {
    expectNear(displayLight(View::Standard, {0.18, 1.5, -0.5}), {0.18, 1, 0}, 0);
}

/// Greys, of which the matrices make nothing else: 0.18 lies 10 stops above the least of 16.5,
/// where the sigmoid is 0.496893 and the light its power of 2.2, by hand.
TEST(ViewAgX, OfGreysIsTheSigmoidOfTheLogarithm) {
    expectNear(ofGrey(View::AgX, 0.018), glm::dvec3(0.0155626), 2e-7);
    expectNear(ofGrey(View::AgX, 0.18), glm::dvec3(0.2145191), 2e-7);
    expectNear(ofGrey(View::AgX, 1), glm::dvec3(0.5901593), 2e-7);
    expectNear(ofGrey(View::AgX, 4), glm::dvec3(0.8609237), 2e-7);
    // Where its range ends, and beyond: the polynomial is 0.99858 at 1.
    expectNear(ofGrey(View::AgX, 16.3), glm::dvec3(std::pow(0.99858, 2.2)), 1e-9);
    expectNear(ofGrey(View::AgX, 1e6), glm::dvec3(std::pow(0.99858, 2.2)), 1e-9);
}

/// Colours are compared by the matrices between Rec. 709 and Rec. 2020 as ITU-R BT.2087 and BT.2407
/// print them, with four digits: the tolerance is theirs.
TEST(ViewAgX, OfColoursIsThePublishedOne) {
    constexpr double rounded = 3e-4;
    expectNear(displayLight(View::AgX, {1, 0, 0}), {0.723276, 0.105847, 0.066736}, rounded);
    expectNear(displayLight(View::AgX, {0, 0, 1}), {0.033961, 0.135589, 0.729971}, rounded);
    expectNear(displayLight(View::AgX, {0.5, 0.2, 0.05}), {0.444814, 0.233061, 0.101035}, rounded);
}

/// What no other view does: light of one channel alone becomes white, where it is very bright.
TEST(ViewAgX, BrightColoursFadeToWhite) {
    const glm::dvec3 blue = displayLight(View::AgX, {0, 0, 1e4});
    EXPECT_GT(std::min({blue.x, blue.y, blue.z}), 0.9);
}

/// Exact fractions: with x = 0.36, (0.04144 / 0.25944 - 1/15) / (19.38 / 24.476 - 1/15).
TEST(ViewFilmic, IsHablesCurve) {
    const double white = 19.38 / 24.476 - 1 / 15.0;
    expectNear(ofGrey(View::Filmic, 0.18), glm::dvec3((0.04144 / 0.25944 - 1 / 15.0) / white),
               1e-12);
    expectNear(ofGrey(View::Filmic, 1), glm::dvec3((0.704 / 1.66 - 1 / 15.0) / white), 1e-12);
    // Each channel by itself, and white is reached at 11.2 / 2.
    expectNear(displayLight(View::Filmic, {0, 1, 5.6}), {0, (0.704 / 1.66 - 1 / 15.0) / white, 1},
               1e-12);
    EXPECT_LT(ofGrey(View::Filmic, 5.5).x, 1);
}

/// The specification's promise: under grey light of radiance 1, a base colour of at most 0.8 that
/// reflects 0.04 without colour shows as the base colour.
TEST(ViewPbrNeutral, BaseColoursComeOutUnchanged) {
    for (const glm::dvec3& base : {glm::dvec3(0.7, 0.3, 0.1), glm::dvec3(0.04), glm::dvec3(0.75)})
        expectNear(displayLight(View::PbrNeutral, base + 0.04), base, 1e-12);
}

/// By hand: of 1, 1 - 0.24^2 / (0.96 + 0.24 - 0.76); of (2, 0.5, 0.1), peak 1.96, new peak 0.96,
/// and 0.15 / 1.15 of the way to it.
TEST(ViewPbrNeutral, HighlightsAreCompressedAndFade) {
    expectNear(ofGrey(View::PbrNeutral, 1), glm::dvec3(1 - 0.0576 / 0.44), 1e-12);
    const double g = 0.15 / 1.15;
    const auto faded = [&](double c) { return c * 0.96 / 1.96 * (1 - g) + 0.96 * g; };
    expectNear(displayLight(View::PbrNeutral, {2, 0.5, 0.1}), {0.96, faded(0.46), faded(0.06)},
               1e-12);
}

/// Below 0.08 the offset is x - 6.25 x^2, so that black stays black.
TEST(ViewPbrNeutral, HasAToe) {
    expectNear(displayLight(View::PbrNeutral, {0.5, 0.02, 0.02}),
               {0.5 - 0.02 + 6.25 * 0.0004, 0.0025, 0.0025}, 1e-12);
}

// --- All of them ---------------------------------------------------------------------------------

TEST(Views, BlackIsBlack) {
    for (const View view : kViews)
        expectNear(ofGrey(view, 0), glm::dvec3(0), 1e-15);
}

/// Rounding aside: the matrices of AgX are between colour spaces of the same white.
TEST(Views, GreyStaysGreyAndRisesWithRadiance) {
    for (const View view : kViews) {
        double before = 0;
        for (double stops = -20; stops <= 20; stops += 1 / 64.0) {
            const glm::dvec3 light = ofGrey(view, std::exp2(stops));
            expectNear(light, glm::dvec3(light.x), 1e-12);
            EXPECT_GE(light.x, before - 1e-12) << nameOf(view) << " at " << stops << " stops";
            before = light.x;
        }
        EXPECT_GT(before, 0.99) << nameOf(view);
    }
}

TEST(Views, ResultsAreOfTheScreen) {
    constexpr double infinity = std::numeric_limits<double>::infinity();
    const std::vector<double> values = {0,   1e-300,   1e-30,     1e-4,        0.08,
                                        0.5, 1,        17.5,      1e5,         1e30,
                                        -1,  infinity, -infinity, std::nan("")};
    for (const View view : kViews)
        for (const double r : values)
            for (const double g : values)
                for (const double b : values) {
                    const glm::dvec3 light = displayLight(view, {r, g, b});
                    for (int c = 0; c < 3; ++c)
                        EXPECT_TRUE(light[c] >= 0 && light[c] <= 1)
                            << nameOf(view) << " of " << r << ", " << g << ", " << b;
                }
}

TEST(Views, WhatIsNoLightCountsAsNone) {
    for (const View view : kViews)
        expectNear(displayLight(view, {0.5, -3, std::nan("")}), displayLight(view, {0.5, 0, 0}), 0);
}

} // namespace
} // namespace stromboli
