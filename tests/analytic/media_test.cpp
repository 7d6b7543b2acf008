// Media with known answers (docs/theory/media.md): what is left of light (Beer and Lambert), what
// is scattered once, furnaces in which nothing is lost, and what shines.
#include "tests/analytic/media.hpp"
#include "tests/support/test_names.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli {
namespace {

using namespace test;

// --- What is left ------------------------------------------------------------------------------

TEST(Media, AbsorbByBeerAndLambert) {
    const glm::vec3 absorption(0.3f, 1.5f, 0);
    const SceneMaker b = slab(mediumOf(absorption, glm::vec3(0)));
    const Estimate found = estimate(b.scene, kAbove, smallPicture(4, 1));
    const glm::dvec3 expected = exponential(lengthInSlab() * glm::dvec3(absorption));
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found.mean[c], expected[c], 2e-6) << c;
}

/// No path of a single ray has scattered.
TEST(Media, WhatHasNotScatteredIsLeftByTheExtinction) {
    const glm::vec3 absorption(0.3f, 1.5f, 0), scattering(0.5f, 0.1f, 2);
    for (const DirectLight mode : kDirectLightModes) {
        RenderSettings s = smallPicture(256, 0);
        s.estimator.directLight = mode;
        const SceneMaker b = slab(mediumOf(absorption, scattering, 0.5f));
        expectMean(estimate(b.scene, kAbove, s),
                   exponential(lengthInSlab() * glm::dvec3(absorption + scattering)));
    }
}

/// The way of a shadow ray from the floor, up through the slab: no noise.
TEST(Media, ShadowRaysKeepTheirShare) {
    const glm::vec3 extinction(0.3f, 1.5f, 0);
    SceneMaker b;
    b.quad({-80, -80, 0}, {160, 0, 0}, {0, 160, 0}, b.add(diffuse(0.5f)));
    b.box({-80, -80, 0.25f}, {80, 80, 0.25f + kThickness},
          b.add(border(b.add(mediumOf(extinction, glm::vec3(0))))));
    Light l;
    l.position = {0.1f, 0.2f, 16};
    b.add(l);
    const Camera below = pointCamera({0.2, 0.1, 0.1}, {0.1, 0.2, 0});
    const Estimate found = estimate(b.scene, below, smallPicture(1, 1));
    const glm::dvec3 expected =
        0.5 / kPi * exponential(double(kThickness) * glm::dvec3(extinction));
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found.mean[c] / expected[c], 1, 1e-4) << c;
}

/// Media within each other, by what surfaces say of both of their sides; spheres and boxes.
TEST(Media, LieWithinEachOther) {
    SceneMaker b;
    b.quad({-8, -8, 0}, {16, 0, 0}, {0, 16, 0}, b.add(emissive(1)));
    const uint32_t thin = b.add(mediumOf(glm::vec3(0.25f), glm::vec3(0)));
    const uint32_t thick = b.add(mediumOf(glm::vec3(0.5f, 1, 2), glm::vec3(0)));
    b.sphere({0, 0, 3}, 2, b.add(border(thin)));
    b.box({-1, -1, 2.5f}, {1, 1, 3.5f}, b.add(border(thick, thin)));
    b.sphere({0, 0, 3}, 0.25f, b.add(border(kNoMedium, thick)));
    const Camera camera = pointCamera({0, 0, 8}, {0, 0, 0});
    const Estimate found = estimate(b.scene, camera, smallPicture(4, 1));
    const glm::dvec3 expected = exponential(glm::dvec3(3 * 0.25) + 0.5 * glm::dvec3(0.5, 1, 2));
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found.mean[c], expected[c], 1e-5) << c;
}

/// A camera says which medium it is in.
TEST(Media, SurroundCameras) {
    SceneMaker b;
    b.quad({-8, -8, 0}, {16, 0, 0}, {0, 16, 0}, b.add(emissive(1)));
    Camera camera = pointCamera({0, 0, 3}, {0, 0, 0});
    camera.medium = b.add(mediumOf(glm::vec3(0.5f), glm::vec3(0)));
    b.sphere({0, 0, 0}, 1, b.add(border(kNoMedium, 0)));
    expectMean(estimate(b.scene, camera, smallPicture(4, 1)), std::exp(-0.5 * 2));
}

/// Light of the environment comes through what there is of the medium, and none through fog without
/// an end.
TEST(Media, DimTheEnvironment) {
    SceneMaker b;
    b.scene.environment = Environment{};
    b.scene.environment->width = b.scene.environment->height = 1;
    b.scene.environment->radiance = {glm::vec3(1)};
    b.sphere({0, 0, 0}, 1, b.add(border(b.add(mediumOf(glm::vec3(0.5f, 1, 2), glm::vec3(0))))));
    const Camera camera = pointCamera({0, 0, 3}, {0, 0, 0});
    expectMean(estimate(b.scene, camera, smallPicture(4, 1)),
               exponential(2.0 * glm::dvec3(0.5, 1, 2)));
    Camera inFog = pointCamera({0, 0, 3}, {0, 0, 8});
    inFog.medium = 0;
    expectMean(estimate(b.scene, inFog, smallPicture(4, 1)), 0);
}

// --- What is scattered ---------------------------------------------------------------------------

/// A narrow, a wide and a backward one.
const std::vector<PhaseLobe> kSumOfPhases = {{PhaseFunction::HenyeyGreenstein, 0.9f, 0.25f},
                                             {PhaseFunction::Rayleigh, 0, 0.5f},
                                             {PhaseFunction::HenyeyGreenstein, -0.6f, 0.25f}};

double phaseDensity(const Medium& m, double turn) {
    double sum = 0;
    for (const PhaseLobe& lobe : m.phases()) {
        const double g = lobe.asymmetry;
        sum += double(lobe.share) *
               (lobe.phase == PhaseFunction::Rayleigh
                    ? 3 / (16 * kPi) * (1 + turn * turn)
                    : (1 - g * g) / (4 * kPi * std::pow(1 + g * g - 2 * g * turn, 1.5)));
    }
    return sum;
}

/// Light of a point at the distance d from a ray in a medium without an end, scattered once: the
/// integral over the ray of sigma_s exp(-sigma_t (t + r)) p(cos) I / r^2. m: the same in all
/// channels.
double scatteredOnce(const glm::dvec3& from, const glm::dvec3& along, const glm::dvec3& light,
                     const Medium& m, double to) {
    const double scattering = m.scattering.x, extinction = m.extinction().x;
    constexpr int kSteps = 200'000;
    double sum = 0;
    for (int i = 0; i < kSteps; ++i) {
        const double t = to * (i + 0.5) / kSteps;
        const glm::dvec3 d = light - (from + t * along);
        const double r = glm::length(d), cosine = -glm::dot(along, d) / r;
        // Light goes along -d, then along -along.
        sum += scattering * std::exp(-extinction * (t + r)) * phaseDensity(m, -cosine) / (r * r);
    }
    return sum * to / kSteps;
}

TEST(Media, ScatterLightOfAPointOnce) {
    for (const float g : {0.0f, 0.7f, -0.5f, 2.0f}) {
        Medium m = mediumOf(glm::vec3(0.0625f), glm::vec3(0.25f), g);
        if (g == 2) m.setPhases(kSumOfPhases);
        SceneMaker b;
        b.quad({-50, -50, -4}, {100, 0, 0}, {0, 100, 0}, b.add(diffuse(0)));
        Camera camera = pointCamera({0, 0, 4}, {0, 0, -4});
        camera.medium = b.add(m);
        Light l;
        l.position = {1, 0.5f, 0.25f};
        l.constantAttenuation = 0;
        l.quadraticAttenuation = 1;
        b.add(l);
        const double expected = scatteredOnce({0, 0, 4}, {0, 0, -1}, l.position, m, 8);
        const Estimate found = estimate(b.scene, camera, smallPicture(256, 1));
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(found.mean[c], expected, 4.5 * found.error[c] + 1e-4 * expected) << g;
    }
}

/// Nothing is lost: a medium that only scatters, lit by the radiance 1 from everywhere, has it
/// everywhere, whatever its density and its phase function.
TEST(Media, WhiteOnesAreFurnaces) {
    for (const DirectLight mode : {DirectLight::Mis, DirectLight::MisAll, DirectLight::Bsdf})
        for (const float g : {0.0f, 0.9f, -0.7f})
            for (const float density : {0.1f, 8.0f}) {
                SceneMaker b;
                b.add(ambient(1));
                Medium m = mediumOf(glm::vec3(0), density * glm::vec3(1, 0.5f, 0.125f), g);
                if (g == 0 && density == 8) m.phase = PhaseFunction::Rayleigh;
                b.sphere({0, 0, 0}, 1, b.add(border(b.add(m))));
                b.sphere({0, 0, 0}, 0.25f, b.add(border(kNoMedium, 0)));
                const Camera camera = pointCamera({0, 0.3, 3}, {0, 0.3, 0});
                RenderSettings s = smallPicture(16, 10'000);
                s.estimator.directLight = mode;
                const Estimate found = estimate(b.scene, camera, s);
                // Rays that never scatter see no backdrop, which ambient light is none of.
                const double chord = 2 * std::sqrt(1 - 0.09);
                for (int c = 0; c < 3; ++c)
                    EXPECT_NEAR(found.mean[c], 1 - std::exp(-m.scattering[c] * chord),
                                4.5 * found.error[c] + kRounding)
                        << nameOf(mode) << ' ' << g << ' ' << density << ' ' << c;
            }
}

/// In a closed room whose walls shine and reflect nothing, every ray ends at a wall; roulette and
/// branches change no mean. Emitters are many, so that they are picked by the tree of lights.
TEST(Media, RoomsOfWhiteFogAreFurnaces) {
    for (const bool hasRoulette : {false, true})
        for (const uint32_t branches : {1u, 4u}) {
            SceneMaker b;
            b.box({-1, -1, -1}, {1, 1, 1}, b.add(emissive(1)), true);
            b.sphere({0.3f, 0.2f, 0.1f}, 0.25f, b.add(emissive(1)));
            Camera camera = pointCamera({-0.5, 0.1, 0.3}, {1, 0.4, 0.2});
            camera.medium = b.add(mediumOf(glm::vec3(0), glm::vec3(2, 1, 0.5f), 0.6f));
            RenderSettings s = smallPicture(16, 10'000);
            s.estimator.branches = branches;
            if (hasRoulette) s.estimator.roulette.mode = Roulette::Mode::Throughput;
            expectMean(estimate(b.scene, camera, s), 1);
        }
}

/// Light that scatters thousands of times keeps its energy.
TEST(Media, KeepEnergyOverThousandsOfScatterings) {
    SceneMaker b;
    b.add(ambient(1));
    b.sphere({0, 0, 0}, 1, b.add(border(b.add(mediumOf(glm::vec3(0), glm::vec3(100))))));
    RenderSettings s = smallPicture(1, 1'000'000);
    s.area.width = s.area.height = 8;
    expectMean(estimate(b.scene, pointCamera({0, 0.3, 3}, {0, 0.3, 0}), s), 1);
}

/// Each channel is what it is alone: the draw of a channel changes no mean.
TEST(Media, ChannelsAreWhatTheyAreAlone) {
    const glm::vec3 absorption(0.5f, 0, 0.125f), scattering(0.25f, 4, 1);
    const auto seen = [&](const glm::vec3& a, const glm::vec3& s) {
        SceneMaker b;
        b.add(ambient(1));
        b.sphere({0, 0, 0}, 1, b.add(border(b.add(mediumOf(a, s, 0.3f)))));
        return estimate(b.scene, pointCamera({0, 0.3, 3}, {0, 0.3, 0}), smallPicture(64, 1000));
    };
    const Estimate together = seen(absorption, scattering);
    for (int c = 0; c < 3; ++c) {
        const Estimate alone = seen(glm::vec3(absorption[c]), glm::vec3(scattering[c]));
        EXPECT_NEAR(together.mean[c], alone.mean[c],
                    4.5 * std::hypot(together.error[c], alone.error[c]) + kRounding)
            << c;
    }
}

/// Bounces alone, light samples with MIS, and uniform directions find the same light of a lamp, so
/// that values, densities and samples of phase functions belong together.
TEST(Media, EstimatorsAgree) {
    for (const float g : {0.9f, -0.6f, 0.0f}) {
        SceneMaker b;
        b.quad({-1, -1, 3}, {0, 2, 0}, {2, 0, 0}, b.add(emissive(4, true)));
        Medium m = mediumOf(glm::vec3(0.125f), glm::vec3(1, 0.5f, 0.25f), g);
        if (g == 0) m.setPhases(kSumOfPhases);
        b.sphere({0, 0, 0}, 1, b.add(border(b.add(m))));
        const auto seen = [&](DirectLight mode, uint32_t samples) {
            RenderSettings s = smallPicture(samples, 20);
            s.estimator.directLight = mode;
            return estimate(b.scene, pointCamera({4, 0.2, 0.1}, {0, 0.2, 0.1}), s);
        };
        const Estimate found = seen(DirectLight::Mis, 256);
        expectSameMean(found, seen(DirectLight::Bsdf, 1024));
        if (isAnotherWay(DirectLight::MisAll))
            expectSameMean(found, seen(DirectLight::MisAll, 256));
    }
}

/// A narrow phase function sends light on as if there were no medium.
TEST(Media, NarrowPhasesPassLightOn) {
    SceneMaker b = slab(mediumOf(glm::vec3(0), glm::vec3(2), kMostAsymmetry));
    expectMean(estimate(b.scene, kAbove, smallPicture(64, 1000)), 1);
}

// --- What shines ---------------------------------------------------------------------------------

/// A medium of extinction s that sends out e per metre: e / s (1 - exp(-s d)) of its own, and the
/// floor behind it.
TEST(Media, Shine) {
    for (const float extinction : {0.0f, 0.01f, 1.5f})
        for (const bool varies : {false, true}) {
            Medium m = mediumOf(glm::vec3(extinction), glm::vec3(0));
            m.emission = glm::vec3(0.5f, 1, 2);
            if (varies && extinction == 0) continue; // no collision would find it
            const SceneMaker whole = slab(m);
            SceneMaker b = whole;
            if (varies) {
                DensityGrid grid;
                grid.size = {1, 1, 1};
                grid.values = {1};
                grid.toUnit = {glm::dvec4(1 / 160.0, 0, 0, 0.5), glm::dvec4(0, 1 / 160.0, 0, 0.5),
                               glm::dvec4(0, 0, 1 / double(kThickness), -0.25 / kThickness)};
                b.scene.media[0].density = grid;
            }
            const double d = lengthInSlab(), s = extinction;
            const double length = s > 0 ? (1 - std::exp(-s * d)) / s : d;
            const Estimate found = estimate(b.scene, kAbove, smallPicture(varies ? 1024 : 4, 2));
            for (int c = 0; c < 3; ++c) {
                const double expected = m.emission[c] * length + std::exp(-s * d);
                EXPECT_NEAR(found.mean[c], expected, 4.5 * found.error[c] + 1e-5 * expected)
                    << extinction << ' ' << varies << ' ' << c;
            }
        }
}

/// All that is emitted in a white medium leaves it: the flux out of a ball is 4 pi times what it
/// sends out, so that the mean radiance over its sphere, seen from outside, follows. Seen along a
/// ray through its middle it is more; what is tested is that scattering loses none of it.
TEST(Media, ShineThroughWhatScatters) {
    SceneMaker b;
    Medium m = mediumOf(glm::vec3(0), glm::vec3(3));
    m.emission = glm::vec3(1);
    b.sphere({0, 0, 0}, 1, b.add(border(b.add(m))));
    // Rays from a far camera over the disk of the ball: its flux is the integral over the disk.
    Camera camera = lookingAt({0, 0, 5}, {0, 0, 0}, 1);
    camera.orthographic = true;
    RenderSettings s = smallPicture(64, 10'000);
    const Estimate found = estimate(b.scene, camera, s);
    // pi L times the sphere's area = 4 pi e V; the picture, of area 4, has the mean L pi / 4.
    const double radiance = 4.0 / 3;
    expectMean(found, radiance * kPi / 4);
}

} // namespace
} // namespace stromboli
