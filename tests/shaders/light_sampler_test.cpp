// The light sampler (shaders/lights/light_sampler.glsl), by way of light.comp: lights are picked as
// often as claimed, also where their powers differ a millionfold; the probability of a given light
// is the one it is picked with; what is left of the random numbers is uniform.
#include "host/bvh/wide_layout.hpp"
#include "host/kernel/kernel_features.hpp"
#include "tests/shaders/light_fixture.hpp"
#include "tests/support/chi_square.hpp"

#include "embedded/light_texel.h"

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>
#include <map>
#include <optional>
#include <string>

namespace stromboli::test {
namespace {

using gpu::LightAnswer;
using gpu::LightQuery;

constexpr size_t kPicks = 400000;

/// Every kind of light, `count` of each bounded one, with powers from 1e-3 to 1e3.
Scene allKinds(int count, uint32_t seed) {
    Random random(seed);
    Scene scene = sceneWithEmitter({1, 1, 1}, true);
    const auto power = [&] { return std::pow(10.0f, random.uniform(-3, 3)); };
    for (int i = 0; i < count; ++i) {
        const glm::vec3 at = random.inCube(2);
        Material m = scene.materials[1];
        m.emission = glm::vec3(power());
        m.emitsBothSides = i % 2;
        scene.materials.push_back(m);
        addEmitterTriangle(scene, at, at + 0.2f * random.vector(), at + 0.2f * random.vector());
        scene.triangles.back().material = uint32_t(scene.materials.size() - 1);
        scene.triangles.back().instance = uint32_t(i);
        scene.spheres.push_back({random.inCube(2), 0.1f, scene.triangles.back().material, 0});
        for (const LightKind kind : {LightKind::Point, LightKind::Spot}) {
            Light& light = scene.lights.emplace_back();
            light.kind = kind;
            light.color = glm::vec3(power());
            light.position = random.inCube(2);
            light.direction = glm::normalize(random.vector());
            light.falloffAngle = 2;
            light.constantAttenuation = i % 3 == 0 ? 1.0f : 0.0f;
            light.quadraticAttenuation = i % 3 == 0 ? 0.0f : 1.0f;
        }
    }
    for (const LightKind kind : {LightKind::Ambient, LightKind::Directional}) {
        Light& light = scene.lights.emplace_back();
        light.kind = kind;
        light.color = glm::vec3(0.3f);
        light.direction = glm::normalize(glm::vec3(0.3f, -1, 0.2f));
    }
    return scene;
}

Scene manyPoints(Random& random, float scale = 1) {
    Scene scene = sceneWithEmitter(glm::vec3(0), true);
    for (int i = 0; i < 40; ++i) {
        Light& light = scene.lights.emplace_back();
        light.kind = LightKind::Point;
        light.color = glm::vec3(std::pow(10.0f, random.uniform(-3, 3)));
        light.constantAttenuation = 0;
        light.quadraticAttenuation = 1;
        light.position = scale * random.inCube(2);
    }
    return scene;
}

/// One-sided triangles at many heights that nearly face down: their cones are narrow, and from
/// between them a node's middle may be seen from behind while some of its lights are not.
Scene panels(Random& random) {
    Scene scene = sceneWithEmitter(glm::vec3(1), false);
    for (int i = 0; i < 40; ++i) {
        const glm::vec3 at = random.inCube(2);
        addEmitterTriangle(scene, at, at + glm::vec3(0.2f, 0.01f * random.uniform(), 0),
                           at + glm::vec3(0, 0.01f * random.uniform(), 0.2f));
        scene.triangles.back().instance = uint32_t(i);
    }
    return scene;
}

struct SamplerCase {
    const char* name;
    LightChoice choice;
};

class LightSampler : public DeviceTest, public ::testing::WithParamInterface<SamplerCase> {
  protected:
    void load(const Scene& scene) {
        packed_ = packScene(scene, buildWideBvh(scene), {.choice = GetParam().choice});
        ShaderOptions options = ShaderOptions::texel();
        options.set(SPEC_LIGHT_CHOICE, lightChoiceConstant(packed_.lights));
        // As the product has it: rows and cones that no light of the scene has are not read.
        options.set(SPEC_LIGHT_KINDS, packed_.lights.sampledKinds);
        if (packed_.lights.groups) options.set(SPEC_LIGHT_GROUPS, packed_.lights.groups);
        options.set(SPEC_LIGHT_TREES_BRANCH, packed_.lights.levels > 0);
        shader_.emplace(light_texel, options);
        shader_->setScene(packed_);
    }
    static LightQuery surface(const glm::vec3& position, const glm::vec3& normal) {
        LightQuery q{};
        q.position = position;
        q.error = glm::vec3(1e-6f);
        q.geometric = q.shading = q.wo = glm::normalize(normal);
        q.outside = 1;
        q.light = gpu::NO_LIGHT;
        return q;
    }
    std::vector<LightAnswer> picks(const LightQuery& from, size_t n, uint32_t seed) {
        Random random(seed);
        std::vector<LightQuery> queries(n, from);
        for (LightQuery& q : queries)
            q.u = random.uniform(), q.v = random.uniform();
        return ask<LightAnswer>(*shader_, queries);
    }
    /// The probability of each light as lightProbability() states it, by LightEntry::light.
    std::map<uint32_t, double> probabilities(const LightQuery& from) {
        std::vector<LightQuery> queries(packed_.lights.count, from);
        for (uint32_t i = 0; i < queries.size(); ++i)
            queries[i].light = i;
        std::map<uint32_t, double> byLight;
        for (const LightAnswer& a : ask<LightAnswer>(*shader_, queries))
            byLight[a.light] = a.again;
        return byLight;
    }

    void expectPicksAsStated(const LightQuery& from, double level);

    GpuScene packed_;
    std::optional<TestShader> shader_;
};

/// Lights are picked from there as often as stated, at this level of the chi-square test.
void LightSampler::expectPicksAsStated(const LightQuery& from, double level) {
    const std::map<uint32_t, double> stated = probabilities(from);
    ASSERT_EQ(stated.size(), packed_.lights.count);
    double sum = 0;
    for (const auto& [light, p] : stated)
        sum += p;
    // A walk down the tree may end where no light reaches the surface: bounds get narrower.
    EXPECT_LT(sum, 1 + 1e-5);
    std::map<uint32_t, double> counts;
    double nowhere = 0;
    for (const LightAnswer& a : picks(from, kPicks, 132)) {
        ASSERT_NEAR(a.probability, stated.at(a.light), 1e-5 * stated.at(a.light) + 1e-9);
        if (a.probability > 0)
            ++counts[a.light];
        else
            ++nowhere;
    }
    std::vector<double> found, expected;
    for (const auto& [light, p] : stated) {
        found.push_back(counts[light]);
        expected.push_back(p * kPicks);
    }
    found.push_back(nowhere);
    expected.push_back(std::max(1 - sum, 0.0) * kPicks);
    EXPECT_GT(chiSquareTest(found, expected), level);
}

TEST_P(LightSampler, PicksAsOftenAsItSays) {
    load(allKinds(12, 131));
    // .01 for the three surfaces of the three choices together.
    for (const LightQuery& from : {surface({0, -1, 0}, {0, 1, 0}), surface({1, 1, 1}, {-1, 0, 0}),
                                   surface({-3, 0.5f, 0}, {1, 0.2f, 0.1f})})
        expectPicksAsStated(from, sidakLevel(0.01, 9));
}

/// A light for each bit: near, unattenuated, infinitely far.
Scene oneLightOfEach(uint32_t groups) {
    Scene scene = sceneWithEmitter(glm::vec3(0), true);
    for (uint32_t group = 0; group < gpu::LIGHT_GROUP_COUNT; ++group) {
        if (!(groups >> group & 1)) continue;
        Light& light = scene.lights.emplace_back();
        light.kind = group == gpu::LIGHT_GROUP_INFINITE ? LightKind::Directional : LightKind::Point;
        light.color = glm::vec3(1 + float(group));
        light.position = {0.5f * float(group), 1, 0};
        light.direction = glm::normalize(glm::vec3(0.3f, -1, 0.2f));
        light.constantAttenuation = group == gpu::LIGHT_GROUP_NEAR ? 0.0f : 1.0f;
        light.quadraticAttenuation = group == gpu::LIGHT_GROUP_NEAR ? 1.0f : 0.0f;
    }
    return scene;
}

/// Groups that the scene does not have, and walks down from a group's only light, are not in its
/// kernel.
TEST_P(LightSampler, PicksAmongGroupsOfOneLight) {
    for (const uint32_t groups : {0b011u, 0b101u, 0b110u, 0b111u}) {
        SCOPED_TRACE(groups);
        load(oneLightOfEach(groups));
        if (GetParam().choice == LightChoice::Tree) {
            EXPECT_EQ(packed_.lights.groups, groups);
            EXPECT_EQ(packed_.lights.levels, 0u);
        }
        // .01 for four sets of groups, two surfaces and three choices together.
        for (const LightQuery& from :
             {surface({0, -1, 0}, {0, 1, 0}), surface({1, 0.2f, 1}, {-0.5f, 0.3f, 0})}) {
            double sum = 0;
            for (const auto& [light, p] : probabilities(from))
                sum += p;
            EXPECT_NEAR(sum, 1, 1e-5);
            expectPicksAsStated(from, sidakLevel(0.01, 24));
        }
    }
}

/// A light that falls off and one that does not, each by where it is: power and cosines over the
/// squared distance of the first, powers and cosines of the second.
TEST_P(LightSampler, WeighsEachGroupByItsOwnLight) {
    if (GetParam().choice != LightChoice::Tree) GTEST_SKIP() << "others have no groups";
    load(oneLightOfEach(0b011));
    const auto nearOverFar = [&](const glm::vec3& place) {
        const std::map<uint32_t, double> p = probabilities(surface(place, {0, 1, 0}));
        return p.begin()->second / p.rbegin()->second;
    };
    const auto expected = [](double below) { // both lights are so far above, and half a metre apart
        return 1 / (below * below) / (below / std::hypot(below, 0.5));
    };
    EXPECT_NEAR(nearOverFar({0, 0, 0}) / nearOverFar({0, -1, 0}), expected(1) / expected(2), 0.02);
}

/// Given the light, the number that is left is uniform: sixteen cells for each light that is picked
/// often.
TEST_P(LightSampler, LeavesAUniformNumber) {
    load(allKinds(12, 131));
    std::map<uint32_t, std::vector<double>> cells;
    const LightQuery from = surface({0, -1, 0}, {0, 1, 0});
    for (const LightAnswer& a : picks(from, kPicks, 133)) {
        ASSERT_GE(a.u, 0);
        ASSERT_LT(a.u, 1);
        auto& counts = cells[a.light];
        counts.resize(16);
        ++counts[size_t(a.u * 16)];
    }
    size_t tested = 0;
    double worst = 1;
    for (const auto& [light, counts] : cells) {
        double all = 0;
        for (const double n : counts)
            all += n;
        if (all < 1600) continue;
        ++tested;
        worst = std::min(worst, chiSquareTest(counts, std::vector<double>(16, all / 16)));
    }
    EXPECT_GT(tested, 3u);
    EXPECT_GT(worst, sidakLevel(0.01, 3 * tested));
}

/// Point lights of these powers at one place, above the origin.
Scene pointLights(std::initializer_list<double> powers) {
    Scene scene = sceneWithEmitter(glm::vec3(0), true);
    for (const double power : powers) {
        Light& light = scene.lights.emplace_back();
        light.kind = LightKind::Point;
        light.color = glm::vec3(float(power));
        light.constantAttenuation = 0;
        light.quadraticAttenuation = 1;
        light.position = {0, 1, 0};
    }
    return scene;
}

/// A light that brings light to a surface may be picked there: the tree's bounds hold. Surfaces lie
/// among the lights and far from them, and many look past nodes that reach over their horizon.
TEST_P(LightSampler, LeavesOutNoLightThatArrives) {
    Random random(135);
    for (const Scene& scene : {allKinds(12, 131), manyPoints(random), panels(random)}) {
        load(scene);
        std::vector<LightQuery> queries;
        for (int i = 0; i < 300; ++i) {
            const LightQuery at =
                surface(random.inCube(i % 2 ? 2.0f : 20.0f), random.inCube(1) + glm::vec3(1e-3f));
            for (uint32_t light = 0; light < packed_.lights.count; ++light)
                for (int k = 0; k < 4; ++k) {
                    queries.push_back(at);
                    queries.back().light = light;
                    queries.back().u = random.uniform(), queries.back().v = random.uniform();
                }
        }
        const std::vector<LightAnswer> answers = ask<LightAnswer>(*shader_, queries);
        size_t arrive = 0, leftOut = 0;
        for (size_t i = 0; i < queries.size(); ++i) {
            // Where the cosine is of the order of rounding, either may be 0.
            const bool arrives = answers[i].radiance.x > 0 &&
                                 glm::dot(queries[i].shading, answers[i].direction) > 1e-5f;
            arrive += arrives;
            leftOut += arrives && !(answers[i].again > 0);
        }
        EXPECT_GT(arrive, queries.size() / 10);
        EXPECT_EQ(leftOut, 0u) << "of " << arrive;
    }
}

/// Lights are chosen as where all lengths are multiplied by a power of two, up to those whose cubes
/// floats no longer hold; beyond, no light is left out.
TEST_P(LightSampler, ChoosesAlikeAtAnyScale) {
    const auto chosen = [&](float scale) {
        Random random(137);
        load(manyPoints(random, scale));
        std::map<uint32_t, double> byLight;
        for (int i = 0; i < 20; ++i) {
            const glm::vec3 at = random.inCube(2);
            for (const auto& [light, p] : probabilities(surface(scale * at, random.inCube(1))))
                byLight[uint32_t(i) * packed_.lights.count + light] = p;
        }
        return byLight;
    };
    const std::map<uint32_t, double> usual = chosen(1);
    EXPECT_EQ(chosen(0x1p-36f), usual);
    EXPECT_EQ(chosen(0x1p40f), usual);
    for (const auto& [light, p] : chosen(0x1p62f))
        EXPECT_TRUE(p > 0 || usual.at(light) == 0) << light;
}

TEST_P(LightSampler, StatesTheProbabilityOfRareLights) {
    if (GetParam().choice == LightChoice::Uniform) GTEST_SKIP() << "all are alike";
    load(pointLights({1, 1e-6, 1e-6}));
    const std::map<uint32_t, double> stated = probabilities(surface({0, 0, 0}, {0, 1, 0}));
    // A share is a multiple of 2^-31, at most rounded down by one: 4.7e-4 of 1e-6. The power of a
    // node is rounded up to 8 bits.
    const double tolerance = GetParam().choice == LightChoice::Tree ? 0x1p-7 : 1e-3;
    EXPECT_NEAR(stated.at(1) / 1e-6, 1, tolerance);
    EXPECT_NEAR(stated.at(2) / 1e-6, 1, tolerance);
}

/// The digits of a random number, multiples of 2^-24, neither decide how often a rare light is
/// picked nor are used up by a choice: of four lights, the last two share 4.53 of the 2^24 numbers,
/// the ones at the end, and the last has a 2049th of that.
TEST_P(LightSampler, RareLightsAreRareExactly) {
    if (GetParam().choice != LightChoice::Tree) GTEST_SKIP() << "an alias table picks in one step";
    // Both together are rounded up to 8 bits, 4.53125 * 2^-24; the other powers have as few bits.
    const double rare = 4.5 * 0x1p-24, rarest = rare / 2048;
    load(pointLights({0.5, 0.5, rare, rarest}));
    constexpr uint32_t kNumbers = 8, kTrials = 40000;
    const LightQuery from = surface({0, 0, 0}, {0, 1, 0});
    Random random(134);
    std::vector<LightQuery> queries;
    for (uint32_t i = 1; i <= kNumbers; ++i)
        for (uint32_t trial = 0; trial < kTrials; ++trial) {
            queries.push_back(from);
            queries.back().u = float((1u << 24) - i) * 0x1p-24f;
            queries.back().v = random.uniform(); // and with it the digits below u's
        }
    double picked[4] = {0, 0, 0, 0};
    for (const LightAnswer& a : ask<LightAnswer>(*shader_, queries))
        ++picked[a.light];
    // Four numbers always pick one of the two, the fifth every other time; rounding of the shares
    // to 2^-31 moves that by less than 1/128.
    const double expected = 4.53125 * kTrials;
    EXPECT_NEAR(picked[2] + picked[3], expected, 4 * std::sqrt(kTrials / 4.0) + kTrials / 128.0);
    EXPECT_NEAR(picked[3], expected / 2049, 4 * std::sqrt(expected / 2049));
}

INSTANTIATE_TEST_SUITE_P(Choices, LightSampler,
                         ::testing::Values(SamplerCase{"tree", LightChoice::Tree},
                                           SamplerCase{"power", LightChoice::Power},
                                           SamplerCase{"uniform", LightChoice::Uniform}),
                         [](const auto& c) { return std::string(c.param.name); });

} // namespace
} // namespace stromboli::test
