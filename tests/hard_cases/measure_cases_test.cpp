// Hard cases 41, 42 and 45: solid angles, frames and choices by weight.
#include "host/kernel/sampling_tables.hpp"
#include "host/reference/lights.hpp"
#include "scene/model/emitters.hpp"
#include "tests/hard_cases/uniform.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace stromboli::test {
namespace {

using namespace reference;

/// Van Oosterom and Strackee 1983.
double solidAngle(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c) {
    const double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
    return 2 * std::abs(std::atan2(glm::dot(a, glm::cross(b, c)),
                                   la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la +
                                       glm::dot(c, a) * lb));
}

/// The mean of 1 / pdf over the samples of a triangular emitter is the solid angle it is seen
/// under.
TEST(HardCases, C41_SolidAnglesOfTriangles) {
    Uniform uniform(41);
    for (int i = 0; i < 30; ++i) {
        Scene scene;
        scene.materials.resize(1);
        scene.materials[0].emission = glm::vec3(1);
        scene.instances = {"emitter"};
        for (int k = 0; k < 3; ++k)
            scene.positions.push_back(glm::vec3(2.0 * uniform.direction()));
        scene.triangles.push_back({{0, 1, 2}});
        const glm::dvec3 a(scene.positions[0]), b(scene.positions[1]), c(scene.positions[2]);
        // Not so near to the plane that 1 / distance^2 has no mean to speak of.
        const glm::dvec3 normal = glm::normalize(glm::cross(b - a, c - a));
        if (std::abs(glm::dot(normal, a)) < 0.4) continue;
        const Lights lights(scene, {});
        SurfacePoint surface;
        surface.geometric = surface.shading = surface.wo = -glm::normalize(a + b + c);
        double sum = 0, naive = 0;
        constexpr uint32_t kCount = 50000;
        for (uint32_t n = 0; n < kCount; ++n) {
            RandomStream random(n, 0, uint32_t(i));
            const LightSample s = lights.sampleBroad(0, surface, random);
            sum += s.value.x;
            naive += s.value.x * glm::length(s.target); // one factor of the distance forgotten
        }
        const double expected = solidAngle(a, b, c);
        EXPECT_NEAR(sum / kCount / expected, 1, 0.015) << i;
        EXPECT_GT(std::abs(naive / kCount / expected - 1), 0.015) << "negative control";
    }
}

/// Frisvad 2012, in float: one division by 1 + z.
double worstOfFrisvad(const glm::vec3& n) {
    if (n.z < -0.9999999f) return 0; // has a branch of its own
    const float a = 1 / (1 + n.z), b = -n.x * n.y * a;
    const glm::dvec3 x(1 - n.x * n.x * a, b, -n.x), y(b, 1 - n.y * n.y * a, -n.y);
    return std::max(
        {std::abs(glm::dot(x, y)), std::abs(glm::dot(x, x) - 1), std::abs(glm::dot(y, y) - 1)});
}

TEST(HardCases, C42_FramesAreOrthonormal) {
    std::vector<glm::dvec3> normals;
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {-1.0, 1.0})
            for (const double zero : {0.0, -0.0}) {
                glm::dvec3 n(zero);
                n[axis] = sign;
                normals.push_back(n);
            }
    // The vectors of Duff et al. 2017, table 1.
    const glm::vec3 bad(0.00038527316f, 0.00038460016f, -0.99999988079f);
    normals.push_back(glm::normalize(glm::dvec3(bad)));
    normals.push_back(glm::normalize(glm::dvec3(-0.00019813581, -0.00008946839, -0.99999988079)));
    Uniform uniform(42);
    for (int i = 0; i < 10000; ++i) {
        glm::dvec3 n = uniform.direction();
        if (i % 2) n.x *= std::exp2(-i % 50), n.y *= std::exp2(-i % 50);
        normals.push_back(glm::normalize(n));
    }
    for (const glm::dvec3& n : normals) {
        const Frame f(n);
        for (const double product :
             {glm::dot(f.x, f.x) - 1, glm::dot(f.y, f.y) - 1, glm::dot(f.x, f.y),
              glm::dot(f.x, f.z), glm::dot(f.y, f.z), glm::dot(glm::cross(f.x, f.y), f.z) - 1})
            ASSERT_NEAR(product, 0, 1e-10);
    }
    EXPECT_GT(worstOfFrisvad(bad), 1e-3) << "negative control: no digit is right near -z";
}

/// Running sums searched for the first that is not below u.
size_t pickNaively(const std::vector<double>& weights, double u) {
    double sum = 0, total = 0;
    for (const double w : weights)
        total += w;
    size_t i = 0;
    for (; i < weights.size(); ++i)
        if ((sum += weights[i]) >= u * total) break;
    return i;
}

TEST(HardCases, C45_WeightsOfZeroAreNeverPicked) {
    for (const std::vector<double>& weights :
         {std::vector<double>{0, 1, 2}, {1, 0, 2}, {1, 2, 0}, {0, 0, 1}, {0.1, 0, 0.1, 0, 0.1}}) {
        const std::vector<AliasColumn> table = buildAliasTable(weights);
        for (size_t i = 0; i < weights.size(); ++i)
            for (const double u : {0.0, 0.5, 1 - 0x1p-24}) {
                const size_t picked = u < table[i].threshold ? i : table[i].alias;
                EXPECT_GT(weights[picked], 0) << i << ' ' << u;
            }
    }
    EXPECT_EQ(pickNaively({0, 1, 2}, 0), 0u) << "negative control: the first one";
    EXPECT_EQ(pickNaively({0.1, 0.2, 0.3}, 1.0000001), 3u) << "negative control: past the end";
    // All of them zero: no light at all.
    Scene dark;
    dark.materials.resize(1);
    dark.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}};
    dark.triangles.push_back({{0, 1, 2}});
    dark.instances = {"triangle"};
    EXPECT_TRUE(collectEmitters(dark).empty());
}

} // namespace
} // namespace stromboli::test
