// Light that scatters under surfaces (docs/theory/media.md, "Under surfaces"): bounces that do not
// count, and reflectances that are turned into media and come back.
#include "tests/analytic/media.hpp"

#include "scene/build/subsurface.hpp"

#include <gtest/gtest.h>

namespace stromboli {
namespace {

using namespace test;

/// A ball of radius 1, of a medium under an interface; ior 1: a border alone.
SceneMaker ballOf(const Medium& m, float ior) {
    SceneMaker b;
    b.add(ambient(1));
    const uint32_t inside = b.add(m);
    Material surface = ior == 1 ? border(inside) : glass(ior);
    surface.boundsMedia = true;
    surface.inside = inside;
    b.sphere({0, 0, 0}, 1, b.add(surface));
    return b;
}

Medium underSurface(Medium m) {
    m.isUnderSurface = true;
    return m;
}

/// Parallel rays: the ball of radius 1, as it is seen from far, touches the edges of the picture.
Camera fromFar() {
    Camera camera = lookingAt({0, 0, 5}, {0, 0, 0}, 1);
    camera.orthographic = true;
    return camera;
}

/// White milk in glass gives back all light, with a limit of bounces that allows only to go in: a
/// reflection, or a refraction after which nothing counts.
TEST(Subsurface, WalksDoNotCountAsBounces) {
    for (const float ior : {1.33f, 1.0f}) {
        const SceneMaker b =
            ballOf(underSurface(mediumOf(glm::vec3(0), glm::vec3(8, 4, 2), 0.3f)), ior);
        for (const DirectLight mode : {DirectLight::Mis, DirectLight::Bsdf})
            for (const uint32_t branches : {1u, 3u}) {
                RenderSettings s = smallPicture(64, 1);
                s.estimator.directLight = mode;
                s.estimator.branches = branches;
                const Estimate found = estimate(b.scene, pointCamera({0, 0.3, 3}, {0, 0.3, 0}), s);
                // Rays that pass the border alone without scattering see no backdrop.
                const double chord = 2 * std::sqrt(1 - 0.09);
                for (int c = 0; c < 3; ++c) {
                    const double expected =
                        ior == 1 ? 1 - std::exp(-b.scene.media[0].scattering[c] * chord) : 1;
                    EXPECT_NEAR(found.mean[c], expected, 4.5 * found.error[c] + kRounding) << ior;
                }
            }
    }
}

/// Each branch may take as many scatterings as a path without branches, though all of them together
/// take more here: 4/3 of a radius by 1.33^2 for each.
TEST(Subsurface, BranchesCountTheirOwnScatterings) {
    const float rate = 400;
    const SceneMaker b = ballOf(underSurface(mediumOf(glm::vec3(0), glm::vec3(rate))), 1.33f);
    RenderSettings s = smallPicture(1, 1);
    s.area.width = 2, s.area.height = 1;
    s.estimator.branches = 512;
    expectMean(estimate(b.scene, pointCamera({0, 0.3, 3}, {0, 0.3, 0}), s), 1);
}

/// A medium where everything counts is darker with few bounces, and the same with many.
TEST(Subsurface, IsTheMediumWithEnoughBounces) {
    const Medium m = mediumOf(glm::vec3(0.1f, 0.3f, 1), glm::vec3(6), 0.3f);
    const Camera camera = pointCamera({0, 0.3, 3}, {0, 0.3, 0});
    const Estimate walks =
        estimate(ballOf(underSurface(m), 1.4f).scene, camera, smallPicture(256, 1));
    const Estimate counts = estimate(ballOf(m, 1.4f).scene, camera, smallPicture(256, 4000));
    expectSameMean(walks, counts);
    EXPECT_LT(estimate(ballOf(m, 1.4f).scene, camera, smallPicture(64, 8)).mean.x,
              0.95 * counts.mean.x);
}

/// Roulette by throughput changes no mean, nor does it begin late.
TEST(Subsurface, RouletteChangesNoMean) {
    const Medium m = underSurface(mediumOf(glm::vec3(0.1f, 0.3f, 1), glm::vec3(6), 0.3f));
    const Camera camera = pointCamera({0, 0.3, 3}, {0, 0.3, 0});
    RenderSettings s = smallPicture(256, 2);
    const Estimate without = estimate(ballOf(m, 1.4f).scene, camera, s);
    s.estimator.roulette.mode = Roulette::Mode::Throughput;
    expectSameMean(without, estimate(ballOf(m, 1.4f).scene, camera, s));
}

/// The mean over the disk of a dense ball, seen from far in light from everywhere, is the share of
/// diffuse light that a medium without an end sends back.
Estimate shareSentBack(const Medium& m, float ior) {
    RenderSettings s = smallPicture(256, 2);
    s.estimator.roulette.mode = Roulette::Mode::Throughput;
    Estimate found = estimate(ballOf(m, ior).scene, fromFar(), s);
    found.mean *= 4 / kPi; // of the picture, whose corners are black
    found.error *= 4 / kPi;
    return found;
}

/// Reflectances become albedos by van de Hulst's formula, and are found again in pictures.
TEST(Subsurface, MediaHaveTheReflectanceThatIsAskedFor) {
    const glm::dvec3 asked(0.25, 0.5, 0.8);
    for (const double g : {0.0, 0.6}) {
        glm::dvec3 albedo(0);
        for (int c = 0; c < 3; ++c) {
            albedo[c] = build::albedoOfDepth(asked[c], g);
            EXPECT_NEAR(build::reflectanceOfDepth(albedo[c], g), asked[c], 1e-12);
        }
        // 500 mean free paths by what turns light around: the ball's edge is no plane within one.
        const double rate = 500 / (1 - g);
        const Estimate found = shareSentBack(
            underSurface(mediumOf(rate * (1.0 - albedo), rate * albedo, float(g))), 1);
        for (int c = 0; c < 3; ++c)
            EXPECT_NEAR(found.mean[c], asked[c], 4.5 * found.error[c] + 0.004) << g << ' ' << c;
    }
}

/// An interface sends light back inside, which is not as diffuse as the formula takes it.
TEST(Subsurface, InterfacesAreCountedIn) {
    const glm::dvec3 asked(0.25, 0.5, 0.8);
    const double ior = 1.33;
    const build::Scattering s = build::scatteringUnder(asked, glm::dvec3(0.002), 0, ior);
    const Estimate found =
        shareSentBack(underSurface(mediumOf(s.absorbed, s.scattered)), float(ior));
    // What the interface reflects of diffuse light (d'Eon and Irving 2011): 0.0667 for 1.33.
    const Estimate black =
        shareSentBack(underSurface(mediumOf(glm::vec3(500), glm::vec3(1e-3f))), float(ior));
    for (int c = 0; c < 3; ++c) {
        const double reflected = black.mean[c];
        EXPECT_NEAR((found.mean[c] - reflected) / (1 - reflected), asked[c], 0.03) << c;
    }
}

} // namespace
} // namespace stromboli
