// Hard cases 30 and 31: spheres from within and from far away, as surfaces and as emitters.
#include "host/bvh/cpu_traversal.hpp"
#include "host/core/random.hpp"
#include "host/stress/device_subject.hpp"
#include "host/stress/scenes.hpp"
#include "tests/hard_cases/cpu_subject.hpp"
#include "tests/hard_cases/hits.hpp"
#include "tests/hard_cases/naive_intersection.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli::test {
namespace {

/// From the middle, from inside, along a tangent, from the surface itself; of radius 1e-6 and 1e6.
/// (Rays that leave by the renderer's own offsets: the case "self-hits" of `stromboli stress`.)
TEST_F(HardCases, C30_SpheresFromEverywhere) {
    Random random(1130);
    uint32_t naiveAgain = 0;
    for (const float radius : {1e-6f, 1.0f, 1e6f}) {
        const glm::vec3 center = radius * random.inCube(1);
        const auto hit = [&](const glm::vec3& origin, const glm::vec3& direction) {
            const auto found =
                hitSphere(center, radius, PreparedRay(origin, direction), 0, kInfiniteDistance);
            return found ? found->t : kInfiniteDistance;
        };
        for (int i = 0; i < 2000; ++i) {
            const glm::vec3 n = glm::normalize(random.vector());
            EXPECT_NEAR(hit(center, n) / radius, 1, 1e-6);
            const glm::vec3 inside = center + 0.5f * radius * random.inCube(1);
            const glm::dvec3 f = glm::dvec3(inside) - glm::dvec3(center), d(n);
            const double r = radius, b = glm::dot(f, d),
                         truth = std::sqrt(b * b - glm::dot(f, f) + r * r) - b;
            EXPECT_NEAR(hit(inside, n) / truth, 1, 1e-6);
            // Off the surface by a few roundings of what the point is made of, and away from it.
            const glm::vec3 on =
                center + radius * (1 + 16 * 0x1p-24f) * n + 4 * 0x1p-24f * n * glm::length(center);
            const glm::vec3 away = glm::normalize(n + 0.9f * glm::normalize(random.vector()));
            EXPECT_EQ(hit(on, away), kInfiniteDistance) << radius << ' ' << i;
            // Where the ray from ten radii away says it hit.
            const glm::vec3 from = center + 10 * radius * n;
            const glm::vec3 found = from - hit(from, -n) * n;
            naiveAgain += hit(found, away) != kInfiniteDistance;
        }
    }
    const auto unit = [](const glm::vec3& origin, const glm::vec3& direction) {
        const auto found = hitSphere({0, 0, 0}, 1, PreparedRay(origin, direction), 0, 10);
        return found ? found->t : -1;
    };
    EXPECT_EQ(unit({1, 0, -3}, {0, 0, 1}), 3) << "a tangent touches";
    EXPECT_EQ(unit({0, 0, -1}, {0, 0, 1}), 2) << "from the surface, through";
    EXPECT_EQ(unit({0, 0, -1}, {0, 0, -1}), -1) << "from the surface, away";
    EXPECT_EQ(unit({0, 0, 3}, {0, 0, 1}), -1) << "behind";
    EXPECT_GT(naiveAgain, 0u) << "negative control: a point along the ray, as it is";
}

struct SphereCase {
    const char* name;
    float radius, height; ///< of its centre over the floor
    float radiance;
    float floor;     ///< half its side: rays start off it by 2^-19 of that
    double expected; ///< irradiance under it
};

/// A floor in an emitter, under one that all but touches it, under one 1e5 radii away: the
/// irradiance is pi L (r / d)^2, pi L inside.
TEST_F(HardCases, C31_SphereEmitters) {
    const double touching = 1 / (1.0001 * 1.0001);
    stress::DeviceSubject device(testDevice());
    CpuSubject cpu;
    for (const SphereCase& l : {SphereCase{"around", 8, 0, 1, 5, M_PI},
                                {"touching", 1, 1.0001f, 1, 5, M_PI * touching},
                                {"far", 0.1f, 1e4f, 1e10f, 5, M_PI},
                                {"tiny and far", 1e-6f, 0.1f, 1e10f, 0.05f, M_PI}}) {
        scenes::SceneMaker m;
        m.quad({-l.floor, 0, -l.floor}, {0, 0, 2 * l.floor}, {2 * l.floor, 0, 0},
               m.add(scenes::diffuse(0.5f)));
        m.sphere({0, l.height, 0}, l.radius, m.add(scenes::emissive(l.radiance, true)));
        // From below 0.8 degrees of elevation the emitter that touches the floor is not in the way.
        const Camera camera = lookingAt({0.6 * l.floor, 0.004 * l.floor, 0}, {0, 0, 0}, 1e-7);
        const RenderSettings s = stress::picture(16, 64, 1);
        for (stress::Subject* subject :
             {static_cast<stress::Subject*>(&device), static_cast<stress::Subject*>(&cpu)}) {
            const stress::Totals found(subject->render(m.scene, camera, s, {}, {}).film);
            EXPECT_EQ(found.all.rejected, 0u) << l.name;
            EXPECT_LE(stress::sigmasOff(found, glm::dvec3(0.5 / M_PI * l.expected)), 4) << l.name;
        }
    }
    // Negative control: the cone's solid angle by 1 - cos.
    const float sine2 = 1e-5f * 1e-5f;
    EXPECT_EQ(1 - std::sqrt(1 - sine2), 0.0f) << "negative control: 1 / pdf = 0 from 1e5 radii";
}

} // namespace
} // namespace stromboli::test
