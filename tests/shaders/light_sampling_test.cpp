// Samples of quads, meshes, ambient and delta lights: where they fall (chi-square, .01 for the
// tests of this file together), what they weigh, and that the emitter does not shade itself.
#include "host/cs184/cs184.hpp"
#include "host/reference/lights.hpp"
#include "host/reference/sampling.hpp"
#include "tests/shaders/light_fixture.hpp"
#include "tests/support/chi_square.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli::test {
namespace {

using gpu::LightAnswer;
using gpu::LightQuery;

constexpr size_t kLightSamples = 100000;
const double kLevel = sidakLevel(0.01, 4);

class LightSampling : public LightFixture {};
class LightSamplingCs184 : public LightFixture {
  protected:
    LightSamplingCs184() : LightFixture(cs184Shading()) {}
};

/// Where the sampled direction meets the plane z = height.
glm::dvec3 onPlane(const LightQuery& q, const LightAnswer& a, double height) {
    const glm::dvec3 o(q.position), d(a.direction);
    return o + (height - o.z) / d.z * d;
}

/// An emitter above the origin that faces down, a parallelogram in the plane z = 2.
struct QuadEmitter {
    glm::vec3 corner{-0.5f, -0.25f, 2}, edgeA{0.25f, 1, 0}, edgeB{1.5f, 0.125f, 0};
    glm::vec3 emission{1, 2, 4};
    double area = glm::length(glm::cross(glm::dvec3(edgeA), glm::dvec3(edgeB)));

    Scene scene(bool bothSides) const {
        Scene s = sceneWithEmitter(emission, bothSides);
        // edgeA x edgeB points down.
        addEmitterTriangle(s, corner, corner + edgeA, corner + edgeA + edgeB);
        addEmitterTriangle(s, corner + edgeA + edgeB, corner + edgeB, corner);
        return s;
    }
};

TEST_F(LightSampling, QuadEmitsOnTheSideItShould) {
    for (const bool bothSides : {false, true}) {
        setScene(QuadEmitter().scene(bothSides));
        const LightQuery below = surfaceAt({0, 0, 1}, {0, 0, 1});
        const LightQuery above = surfaceAt({0, 0, 3}, {0, 0, -1});
        for (const LightAnswer& a : answers(samples(below, 1000, 122)))
            ASSERT_GT(a.radiance.x, 0);
        for (const LightAnswer& a : answers(samples(above, 1000, 122))) {
            ASSERT_EQ(a.radiance.x > 0, bothSides);
            ASSERT_EQ(a.blocked, 0u);
        }
        const LightQuery inItsPlane = surfaceAt({5, 0, 2}, {-1, 0, 0});
        for (const LightQuery& from : {below, above, inItsPlane})
            for (const LightAnswer& a : answers(ends(from)))
                EXPECT_TRUE(isSound(a));
    }
}

TEST_F(LightSampling, QuadAnywhereInSpaceNeverShadesItself) {
    Random random(123);
    for (int k = 0; k < 20; ++k) {
        const float scale = std::exp2(float(random.below(40)) - 20);
        const glm::vec3 far = (k % 2 ? 1000.0f : 1.0f) * scale * random.inCube(1);
        const glm::vec3 corner = far + scale * random.inCube(1);
        const glm::vec3 edgeA = scale * random.vector();
        const glm::vec3 edgeB = scale * glm::cross(random.vector(), glm::normalize(edgeA));
        Scene s = sceneWithEmitter({1, 1, 1}, true);
        addEmitterTriangle(s, corner, corner + edgeA, corner + edgeA + edgeB);
        addEmitterTriangle(s, corner, corner + edgeA + edgeB, corner + edgeB);
        setScene(s);
        std::vector<LightQuery> queries;
        for (int i = 0; i < 500; ++i) {
            const glm::vec3 p = far + 3.0f * scale * random.inCube(1);
            const auto some = samples(surfaceAt(p, corner - p), 4, random.below(1u << 30));
            queries.insert(queries.end(), some.begin(), some.end());
        }
        uint32_t blocked = 0;
        for (const LightAnswer& a : answers(queries))
            blocked += a.blocked && a.radiance.x > 0;
        EXPECT_EQ(blocked, 0u) << k << ": scale " << scale;
    }
}

TEST_F(LightSampling, AmbientByTheCosineAboutTheNormal) {
    for (const bool upper : {false, true}) {
        Scene scene = sceneWithEmitter(glm::vec3(0.0f), true);
        Light light;
        light.kind = LightKind::Ambient;
        light.color = {1, 2, 3};
        light.upperHemisphereOnly = upper;
        scene.lights.push_back(light);
        setScene(scene);
        const LightQuery surface = surfaceAt({1, 2, 3}, {0.6f, -0.64f, 0.48f});
        const glm::dvec3 normal(surface.shading);
        std::vector<double> counts(20);
        for (const LightAnswer& a : answers(samples(surface, kLightSamples, 125))) {
            ASSERT_TRUE(isSound(a));
            ASSERT_EQ(a.infinite, 1u);
            const double cosine = glm::dot(glm::dvec3(a.direction), normal);
            ASSERT_GE(cosine, -1e-6);
            const bool reaches = !upper || a.direction.y > 0;
            if (cosine > 1e-3 && std::abs(a.direction.y) > 1e-6f) {
                ASSERT_NEAR(a.radiance.z * cosine / (reaches ? 3 * kPi : 1), reaches ? 1 : 0, 1e-3);
            }
            // cos^2 is uniform.
            ++counts[std::min(size_t(std::max(cosine * cosine, 0.0) * 20), size_t(19))];
        }
        EXPECT_GT(chiSquareTest(counts, std::vector<double>(20, kLightSamples / 20.0)), kLevel);
    }
}

/// Ambient light from everywhere and from above is one light, the sum of all.
TEST_F(LightSampling, AmbientLightsAddUp) {
    Scene scene = sceneWithEmitter(glm::vec3(0.0f), true);
    for (const bool upper : {false, true, false, true}) {
        Light& light = scene.lights.emplace_back();
        light.kind = LightKind::Ambient;
        light.color = upper ? glm::vec3(0, 0, 5) : glm::vec3(1, 2, 0);
        light.upperHemisphereOnly = upper;
    }
    setScene(scene);
    ASSERT_EQ(packed_.lights.count, 1u);
    const LightQuery surface = surfaceAt({1, 2, 3}, {1, 0, 0});
    for (const LightAnswer& a : answers(samples(surface, 1000, 128))) {
        const double inversePdf = kPi / std::max(double(a.direction.x), 1e-30);
        if (a.direction.x < 1e-3f) continue;
        EXPECT_NEAR(a.radiance.x / (2 * inversePdf), 1, 1e-3);
        EXPECT_NEAR(a.radiance.z / inversePdf, a.direction.y > 0 ? 10 : 0, 1e-2);
    }
}

TEST_F(LightSampling, DeltaLightsAsTheReferenceHasThem) {
    Random random(126);
    for (int k = 0; k < 60; ++k) {
        Scene scene = sceneWithEmitter(glm::vec3(0.0f), true);
        Light& light = scene.lights.emplace_back();
        constexpr LightKind kKinds[] = {LightKind::Directional, LightKind::Point, LightKind::Spot};
        light.kind = kKinds[k % 3];
        light.color = {1, 20, 300};
        light.position = random.inCube(2);
        light.direction = glm::normalize(random.vector());
        light.constantAttenuation = random.uniform();
        light.linearAttenuation = random.uniform();
        light.quadraticAttenuation = 0.01f + random.uniform();
        light.falloffAngle = random.uniform(0.2f, 3);
        light.falloffExponent = k % 2 ? 0 : random.uniform(0, 20);
        if (k % 5 == 0) light.innerAngle = light.falloffAngle * random.uniform(0, 0.8f);
        setScene(scene);
        const reference::Lights expected(scene, {});
        std::vector<LightQuery> queries;
        for (int i = 0; i < 100; ++i) // around the axis
            queries.push_back(surfaceAt(light.position + random.uniform(0.5f, 2) *
                                                             (light.direction + random.inCube(1)),
                                        random.vector()));
        const std::vector<LightAnswer> found = answers(queries);
        for (size_t i = 0; i < queries.size(); ++i) {
            reference::SurfacePoint s;
            s.position = queries[i].position;
            reference::RandomStream numbers(0, uint32_t(i), 0);
            const reference::LightSample e = expected.sampleDelta(0, s, numbers);
            ASSERT_TRUE(isSound(found[i]));
            EXPECT_EQ(found[i].infinite != 0, e.infinite);
            EXPECT_LT(glm::length(glm::dvec3(found[i].direction) - e.direction), 1e-6);
            const double cosine = -glm::dot(e.direction, glm::dvec3(light.direction));
            if (std::abs(cosine - std::cos(double(light.falloffAngle) / 2)) < 1e-5) continue;
            // pow to 16 ulp per exponent (Vulkan) of a cosine that rounding has changed.
            for (int c = 0; c < 3; ++c)
                EXPECT_NEAR(found[i].radiance[c], e.value[c], 2e-4 * e.value[c] + 1e-6);
        }
    }
}

/// docs/guide/cs184.md, "CS184 mode": nothing unless D . n < 0; area cos_light / |D|.
TEST_F(LightSamplingCs184, RectangleWithOneFactorOfDistanceTooFew) {
    Scene scene = sceneWithEmitter(glm::vec3(0.0f), true);
    Light& light = scene.lights.emplace_back();
    light.kind = LightKind::Area;
    light.color = {10, 5, 1};
    light.position = {0, 0, 2};
    light.direction = {0, 0, -1};
    light.edgeX = {1.5f, 0, 0};
    light.edgeY = {0, 0.5f, 0};
    setScene(scene);
    const auto queries = samples(surfaceAt({0.25f, 1, -1}, {0, 0, 1}), 10000, 127);
    const std::vector<LightAnswer> found = answers(queries);
    for (size_t i = 0; i < found.size(); ++i) {
        const glm::dvec3 p = onPlane(queries[i], found[i], 2);
        const glm::dvec3 to = p - glm::dvec3(queries[i].position);
        const double distance = glm::length(to), cosine = to.z / distance;
        ASSERT_LE(std::abs(p.x), 0.75 + 1e-5);
        ASSERT_LE(std::abs(p.y), 0.25 + 1e-5);
        ASSERT_NEAR(found[i].radiance.x / (10 * 0.75 * cosine / distance), 1, 3e-6) << i;
    }
    for (const LightAnswer& a : answers(samples(surfaceAt({0, 0, 3}, {0, 0, -1}), 100, 127)))
        EXPECT_EQ(a.radiance, glm::vec3(0.0f)) << "from behind";
}

} // namespace
} // namespace stromboli::test
