// light_tree.glsl by way of light.comp: triangles are picked as often as claimed, the light of all
// of them is what Lambert's formula says, with less noise than picking one uniformly.
#include "host/kernel/kernel_features.hpp"
#include "scene/generate/generated_scene.hpp"
#include "tests/shaders/light_fixture.hpp"

#include "embedded/light_texel.h"
#include "tests/support/test_names.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli::test {
namespace {

using gpu::LightAnswer;
using gpu::LightQuery;

constexpr size_t kSamplesOfMany = 100000;

/// Irradiance of a triangle of radiance 1 on a point with unit normal n (Lambert), nothing of it
/// below the horizon.
double irradiance(const glm::dvec3 corners[3], const glm::dvec3& n) {
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
        const glm::dvec3 p = glm::normalize(corners[i]), q = glm::normalize(corners[(i + 1) % 3]);
        const glm::dvec3 c = glm::cross(p, q);
        sum += std::atan2(glm::length(c), glm::dot(p, q)) * glm::dot(glm::normalize(c), n);
    }
    return std::abs(sum) / 2;
}

struct Estimate {
    double mean = 0, variance = 0; ///< of one sample
};

class ManyLights : public DeviceTest, public ::testing::WithParamInterface<LightChoice> {
  protected:
    ManyLights() : scene_(generatedScene("lamps:2000")) {
        for (size_t i = 0; i < scene_.triangles.size(); i += 3) // some emit on both sides
            if (scene_.materials[scene_.triangles[i].material].emits())
                scene_.triangles[i].material = uint32_t(scene_.materials.size());
        Material other = scene_.materials.back();
        other.emission = {3, 90, 20};
        other.emitsBothSides = true;
        scene_.materials.push_back(other);
    }
    Estimate estimate(LightChoice choice, const LightQuery& surface) {
        const GpuScene packed = packScene(scene_, buildWideBvh(scene_), {.choice = choice});
        TestShader shader(light_texel, ShaderOptions::texel().set(
                                           SPEC_LIGHT_CHOICE, lightChoiceConstant(packed.lights)));
        shader.setScene(packed);
        Random random(151);
        std::vector<LightQuery> queries(kSamplesOfMany, surface);
        for (LightQuery& q : queries)
            q.u = random.uniform(), q.v = random.uniform();
        Estimate e;
        for (const LightAnswer& a : ask<LightAnswer>(shader, queries)) {
            EXPECT_TRUE(isSound(a));
            const double value =
                a.radiance.y * std::max(double(glm::dot(a.direction, surface.shading)), 0.0);
            e.mean += value / kSamplesOfMany;
            e.variance += value * value / kSamplesOfMany;
        }
        e.variance -= e.mean * e.mean;
        return e;
    }
    /// Irradiance of all triangles, nothing hidden.
    double truth(const LightQuery& surface) const {
        double sum = 0;
        for (const Triangle& t : scene_.triangles) {
            const Material& m = scene_.materials[t.material];
            if (!m.emits()) continue;
            glm::dvec3 corners[3];
            for (int i = 0; i < 3; ++i)
                corners[i] =
                    glm::dvec3(scene_.positions[t.corner[i]]) - glm::dvec3(surface.position);
            const glm::dvec3 n = glm::cross(corners[1] - corners[0], corners[2] - corners[0]);
            if (!m.emitsBothSides && glm::dot(n, corners[0]) >= 0) continue;
            sum += m.emission.y * irradiance(corners, surface.shading);
        }
        return sum;
    }
    /// On the floor: all lights are above the horizon.
    static LightQuery floor(float x, float z) {
        LightQuery q{};
        q.position = {x, -1, z};
        q.error = glm::vec3(1e-6f);
        q.geometric = q.shading = q.wo = {0, 1, 0};
        q.outside = 1;
        q.light = gpu::NO_LIGHT;
        return q;
    }

    Scene scene_;
};

TEST_P(ManyLights, BringTheLightOfAllOfThem) {
    for (const LightQuery& surface : {floor(0.1f, 0.2f), floor(-0.97f, 0.5f)}) {
        const Estimate e = estimate(GetParam(), surface);
        // Eight such means: 4.5 sigma.
        EXPECT_NEAR(e.mean, truth(surface), 4.5 * std::sqrt(e.variance / kSamplesOfMany));
        EXPECT_GT(e.mean, 0);
    }
}

std::string nameOf(const ::testing::TestParamInfo<LightChoice>& test) {
    return test.param == LightChoice::Tree    ? "tree"
           : test.param == LightChoice::Power ? "power"
                                              : "uniform";
}

INSTANTIATE_TEST_SUITE_P(Choices, ManyLights,
                         ::testing::Values(LightChoice::Tree, LightChoice::Power,
                                           LightChoice::Uniform),
                         nameOf);

class ManyLightsByTree : public ManyLights {};

TEST_P(ManyLightsByTree, HaveThreeTimesLessNoiseThanByPowerAndFiveThanUniformly) {
    const LightQuery surface = floor(0.1f, 0.2f);
    const double tree = estimate(LightChoice::Tree, surface).variance;
    EXPECT_GT(estimate(LightChoice::Power, surface).variance, 3 * tree);
    EXPECT_GT(estimate(LightChoice::Uniform, surface).variance, 5 * tree);
}

INSTANTIATE_TEST_SUITE_P(Noise, ManyLightsByTree, ::testing::Values(LightChoice::Tree),
                         [](const auto& one) { return test::testName(nameOf(one.param)); });

} // namespace
} // namespace stromboli::test
