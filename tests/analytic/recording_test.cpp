// The path of one sample, vertex by vertex: closed forms, and that the vertices add up to the
// sample.
#include "shaders/shared/bsdf_types.h"
#include "tests/analytic/scenes.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <ostream>

namespace stromboli {
namespace {

using namespace test;

constexpr double kTurn = 2 * 3.14159265358979323846;

void expectNear(const glm::dvec3& found, const glm::dvec3& expected, double tolerance,
                const char* what) {
    for (int c = 0; c < 3; ++c)
        EXPECT_NEAR(found[c], expected[c], tolerance) << what << ", channel " << c;
}

/// A grey floor, two metres under a point light, of which one point is seen.
TEST(Recording, AFloorUnderALamp) {
    constexpr double kAlbedo = 0.5, kIntensity = 3, kHeight = 2;
    SceneMaker maker;
    addFloor(maker, maker.add(diffuse(float(kAlbedo))));
    Light light = pointLight(float(kIntensity), {0, float(kHeight), 0});
    light.constantAttenuation = 0;
    light.quadraticAttenuation = 1;
    maker.add(light);
    const RenderSettings settings = smallPicture(1, 2);
    const Camera camera = pointCamera({0, 3, 4}, {0, 0, 0});
    const RecordedPath path = recordedAlone(maker.scene, camera, settings, 0, 0);

    expectNear(path.origin, {0, 3, 4}, 1e-6, "where the camera is");
    ASSERT_EQ(path.vertices.size(), 2u);
    const RecordedVertex& floor = path.vertices[0];
    EXPECT_EQ(floor.met, RecordedVertex::Met::Surface);
    EXPECT_LT(floor.primitive, 2u);
    expectNear(floor.position, {0, 0, 0}, 1e-5, "position");
    EXPECT_NEAR(floor.distance, 5, 1e-5);
    expectNear(floor.throughput, {1, 1, 1}, 0, "throughput");
    expectNear(floor.light, {0, 0, 0}, 0, "emission");
    ASSERT_EQ(floor.lights.size(), 1u);
    const RecordedLight& lamp = floor.lights[0];
    EXPECT_EQ(lamp.fate, RecordedLight::Fate::Arrives);
    EXPECT_EQ(lamp.pdf, 0);
    EXPECT_EQ(lamp.weight, 1);
    expectNear(lamp.direction, {0, 1, 0}, 1e-5, "to the lamp");
    EXPECT_NEAR(lamp.distance, kHeight, 1e-4 * kHeight);
    const double brings = kAlbedo / (kTurn / 2) * kIntensity / (kHeight * kHeight);
    expectNear(lamp.light, glm::dvec3(brings), 1e-5 * brings, "what the lamp brings");
    ASSERT_TRUE(floor.bounce);
    EXPECT_EQ(floor.bounce->lobe, gpu::LOBE_DIFFUSE_REFLECTION);
    EXPECT_NEAR(glm::length(floor.bounce->direction), 1, 1e-6);
    EXPECT_NEAR(floor.bounce->pdf, floor.bounce->direction.y / (kTurn / 2), 1e-5);
    expectNear(floor.bounce->throughput, glm::dvec3(kAlbedo), 1e-6, "throughput after it");
    EXPECT_TRUE(floor.bounce->survives);
    EXPECT_EQ(floor.bounce->goesOn, 1);
    const RecordedVertex& sky = path.vertices[1];
    EXPECT_EQ(sky.met, RecordedVertex::Met::Nothing);
    EXPECT_FALSE(sky.bounce);
    expectNear(path.radiance, glm::dvec3(brings), 1e-5 * brings, "radiance");
}

/// A path that a roulette of known probability ends is one that it did not let go on.
TEST(Recording, SaysWhatRouletteDoes) {
    RenderSettings settings = smallPicture(1, 30);
    settings.estimator.roulette.mode = Roulette::Mode::Throughput;
    const Scene scene = cornellBox();
    const Camera camera = pointCamera({0.5, 0.5, 0.95}, {0.5, 0.4, 0}, 0.8);
    size_t ended = 0;
    for (uint32_t sample = 0; sample < 8; ++sample) {
        const RecordedPath path = recordedAlone(scene, camera, settings, 5, sample);
        for (size_t i = 0; i < path.vertices.size(); ++i) {
            const std::optional<RecordedBounce>& bounce = path.vertices[i].bounce;
            EXPECT_EQ(bounce && bounce->survives, i + 1 < path.vertices.size());
            if (!bounce) continue;
            EXPECT_LE(bounce->goesOn, 1);
            if (i + 1 < Roulette::kThroughputStart) {
                EXPECT_EQ(bounce->goesOn, 1);
            }
            if (bounce->goesOn < 1 && !bounce->survives) ++ended;
        }
    }
    EXPECT_GT(ended, 0u);
}

struct Way {
    const char* name;
    std::function<void(Estimator&)> set;
};
std::ostream& operator<<(std::ostream& out, const Way& way) {
    return out << way.name;
}

class RecordingAddsUp : public testing::TestWithParam<Way> {};

/// Some of whose samples are bright.
void expectToAddUp(const Scene& scene, const Camera& camera, const RenderSettings& settings) {
    constexpr uint32_t kPixel = 21, kSamples = 6;
    double brightest = 0;
    const std::vector<SampleValue> alone = samplesAlone(scene, camera, settings, kPixel, kSamples);
    for (uint32_t i = 0; i < kSamples; ++i) {
        const RecordedPath path = recordedAlone(scene, camera, settings, kPixel, i);
        EXPECT_EQ(path.radiance, alone[i].radiance) << i;
        EXPECT_EQ(path.rejected, alone[i].rejected);
        EXPECT_TRUE(path.isWhole);
        const double size = glm::length(path.radiance);
        brightest = std::max(brightest, size);
        expectNear(sumOf(path), path.radiance, 1e-5 * size, "sum of the vertices");
        for (const RecordedVertex& vertex : path.vertices)
            EXPECT_LE(vertex.branch, settings.estimator.branches);
    }
    EXPECT_GT(brightest, 0);
}

/// The sample is that of a render to the last bit, and its vertices sum up to it: in a room that is
/// lit by light samples, and under a sky that bounces find.
TEST_P(RecordingAddsUp, ToTheSample) {
    RenderSettings settings = smallPicture(8, 6);
    settings.estimator.roulette.mode = Roulette::Mode::Throughput;
    GetParam().set(settings.estimator);
    expectToAddUp(sphereInAmbientLight(diffuse(0.6f)), kOutside, settings);
    if (settings.estimator.directLight == DirectLight::Bsdf) return; // hardly finds the small lamp
    expectToAddUp(cornellBox(), pointCamera({0.5, 0.5, 0.95}, {0.5, 0.4, 0}, 0.8), settings);
}

INSTANTIATE_TEST_SUITE_P(
    Ways, RecordingAddsUp,
    testing::Values(Way{"Plain", [](Estimator&) {}},
                    Way{"Branches", [](Estimator& e) { e.branches = 4; }},
                    Way{"SharedLight",
                        [](Estimator& e) {
                            e.directLight = DirectLight::MisAll;
                            e.lightSamples = 3;
                        }},
                    Way{"Hemisphere",
                        [](Estimator& e) { e.directLight = DirectLight::Hemisphere; }},
                    Way{"ByBounces", [](Estimator& e) { e.directLight = DirectLight::Bsdf; }},
                    Way{"FixedRoulette",
                        [](Estimator& e) {
                            e.roulette.mode = Roulette::Mode::Fixed;
                            e.roulette.terminationProbability = 0.2;
                        }},
                    Way{"Weighted",
                        [](Estimator& e) {
                            e.filter = PixelFilter::Mitchell;
                            e.minBounce = 1;
                        }}),
    [](const auto& way) { return std::string(way.param.name); });

} // namespace
} // namespace stromboli
