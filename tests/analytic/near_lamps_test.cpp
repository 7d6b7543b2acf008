// Distances in media that are drawn about lamps near the ray (docs/theory/media.md, "Lamps that are
// near"): thin media with known answers, which are those of any other draw of distances, and less
// noise.
#include "scene/model/light_foci.hpp"
#include "tests/analytic/media.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace stromboli {
namespace {

using namespace test;

Light lampAt(const glm::vec3& position, const glm::vec3& color) {
    Light l;
    l.position = position;
    l.color = color;
    l.constantAttenuation = 0;
    l.quadraticAttenuation = 1;
    return l;
}

/// Light of lamps that is scattered once, at equal angles, on a ray from `from` of the length `to`:
/// the integral of sigma_s exp(-sigma_t (t + r)) I / (4 pi r^2) is one over the angle of a smooth
/// function.
glm::dvec3 lampsScatteredOnce(const Scene& scene, const Medium& m, const glm::dvec3& from,
                              const glm::dvec3& along, double to) {
    constexpr int kSteps = 20'000;
    glm::dvec3 sum(0.0);
    for (const Light& l : scene.lights) {
        const glm::dvec3 d = glm::dvec3(l.position) - from;
        const double closest = glm::dot(d, along), apart = glm::length(d - closest * along);
        const double first = std::atan(-closest / apart), last = std::atan((to - closest) / apart);
        for (int i = 0; i < kSteps; ++i) {
            const double angle = first + (last - first) * (i + 0.5) / kSteps;
            const double t = closest + apart * std::tan(angle), r = apart / std::cos(angle);
            const glm::dvec3 left = exponential((t + r) * glm::dvec3(m.extinction()));
            sum += glm::dvec3(m.scattering) * left * glm::dvec3(l.color) *
                   ((last - first) / kSteps / (4 * kPi * apart));
        }
    }
    return sum;
}

struct Haze {
    glm::vec3 absorption, scattering;
};

/// Fogs of one colour, of two that differ tenfold, and so thin that a path scatters once in a
/// thousand metres.
const std::vector<Haze> kHazes = {
    {glm::vec3(0.01f), glm::vec3(0.04f)},
    {{0.002f, 0, 0.03f}, {0.005f, 0.05f, 0.02f}},
    {glm::vec3(0), glm::vec3(0.001f)},
};

/// In fog without an end, and in a slab between the camera and a black floor.
TEST(NearLamps, ScatterTheirLightOnce) {
    for (const Haze& haze : kHazes)
        for (const bool isSlab : {false, true}) {
            const Medium m = mediumOf(haze.absorption, haze.scattering);
            SceneMaker b;
            const glm::dvec3 from(0, 0, 4), along(0, 0, -1);
            Camera camera = pointCamera(from, {0, 0, -4});
            camera.medium = b.add(m);
            b.add(lampAt({0.25f, 0.125f, 1}, {1, 2, 4}));
            b.add(lampAt({-0.5f, 0.75f, 2}, {2, 1, 0.5f}));
            if (isSlab)
                b.quad({-20, -20, 0.75f}, {40, 0, 0}, {0, 40, 0}, b.add(diffuse(0)));
            else
                b.sphere({100, 0, 0}, 1, b.add(diffuse(0)));
            ASSERT_EQ(lightFoci(b.scene).near.size(), 2u);
            const glm::dvec3 expected =
                lampsScatteredOnce(b.scene, m, from, along, isSlab ? 3.25 : 1e6);
            const Estimate found = estimate(b.scene, camera, smallPicture(256, 1));
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(found.mean[c], expected[c], 4.5 * found.error[c] + 1e-4 * expected[c])
                    << isSlab << ' ' << haze.scattering.x << ' ' << c;
        }
}

/// By extinction alone the variance of a sample is at least its mean squared over 2 pi times
/// extinction times distance, 64 here; drawn about the lamp, no more than a few.
TEST(NearLamps, ScatterWithLittleNoise) {
    SceneMaker b;
    Camera camera = pointCamera({0, 0, 4}, {0, 0, -4});
    camera.medium = b.add(mediumOf(glm::vec3(0), glm::vec3(0.01f)));
    b.add(lampAt({0.25f, 0, 0}, glm::vec3(1)));
    b.quad({-50, -50, -400}, {100, 0, 0}, {0, 100, 0}, b.add(diffuse(0)));
    const RenderSettings s = smallPicture(256, 1);
    const Estimate found = estimate(b.scene, camera, s);
    const double samples = 256.0 * s.area.width * s.area.height;
    EXPECT_LT(found.error.x * std::sqrt(samples), 2 * found.mean.x);
}

/// What a ray meets at the end of the stretch is left by the extinction, whatever is drawn before.
TEST(NearLamps, LeaveWhatIsBehindThem) {
    SceneMaker b;
    const Medium m = mediumOf({0.01f, 0.02f, 0}, {0.03f, 0.04f, 0.01f});
    Camera camera = pointCamera({0, 0, 4}, {0, 0, -4});
    camera.medium = b.add(m);
    b.add(lampAt({0.25f, 0, 2}, glm::vec3(100)));
    b.quad({-50, -50, 0}, {100, 0, 0}, {0, 100, 0}, b.add(emissive(1)));
    expectMean(estimate(b.scene, camera, smallPicture(256, 0)),
               exponential(4.0 * glm::dvec3(m.extinction())));
}

/// A closed room whose walls shine and reflect nothing is a furnace also with a lamp in it that
/// shines as they do, about which distances are drawn.
TEST(NearLamps, AreInFurnaces) {
    for (const bool isMesh : {false, true}) {
        SceneMaker b;
        b.box({-1, -1, -1}, {1, 1, 1}, b.add(emissive(1)), true);
        const uint32_t lamp = b.add(emissive(1));
        if (isMesh)
            b.box({0.25f, 0.125f, 0}, {0.28f, 0.155f, 0.03f}, lamp);
        else
            b.sphere({0.3f, 0.2f, 0.1f}, 0.02f, lamp);
        Camera camera = pointCamera({-0.5, 0.1, 0.3}, {1, 0.4, 0.2});
        camera.medium = b.add(mediumOf(glm::vec3(0), glm::vec3(0.2f, 0.1f, 0.05f), 0.6f));
        ASSERT_EQ(lightFoci(b.scene).near.size(), 1u);
        expectMean(estimate(b.scene, camera, smallPicture(64, 1000)), 1);
    }
}

/// Lamps that are wide beside the free path, and scenes without a medium that scatters, have none;
/// lamps that lie together are one.
TEST(NearLamps, AreSmallBesideTheFreePath) {
    const auto foci = [](float scattering, float radius, float distance) {
        SceneMaker b;
        b.add(mediumOf(glm::vec3(0.01f), glm::vec3(scattering)));
        b.sphere({0, 0, 0}, radius, b.add(emissive(1)));
        b.sphere({distance, 0, 0}, radius, b.add(emissive(2)));
        b.sphere({100, 0, 0}, 1, b.add(diffuse(0)));
        return lightFoci(b.scene);
    };
    EXPECT_EQ(foci(0, 0.01f, 1).near.size(), 0u);
    EXPECT_EQ(foci(1, 0.1f, 1).near.size(), 0u);
    EXPECT_EQ(foci(1, 0.01f, 1).near.size(), 2u);
    const LightFoci together = foci(0.04f, 0.01f, 0.1f); // a hundredth of the free path is 0.2
    ASSERT_EQ(together.near.size(), 1u);
    EXPECT_NEAR(together.near[0].point.x, 0.05, 1e-6);
    EXPECT_NEAR(together.near[0].radius, 0.06, 1e-6);
    EXPECT_NEAR(together.near[0].intensity, 3 * kPi * 1e-4, 1e-8);
    EXPECT_NEAR(together.near[0].radiance, 2, 1e-6);
}

} // namespace
} // namespace stromboli
