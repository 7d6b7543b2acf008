// Lights that are picked by how much of their light arrives: no bias for any factors, lights behind
// walls get few samples, and trees hold what they are given.
#include "host/kernel/arriving_light.hpp"
#include "host/kernel/light_shares.hpp"
#include "host/kernel/light_table.hpp"
#include "tests/kernel/window_room.hpp"
#include "tests/render/device_render.hpp"
#include "tests/support/device_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <optional>
#include <vector>

namespace stromboli {
namespace {

using namespace test;

/// The room with a window of that side, with lamps below its ceiling under a bright sky.
Scene roomWithLamps(float window, uint32_t lamps) {
    scenes::SceneMaker b;
    b.scene = roomWithWindow(window);
    b.scene.environment->strength = 100;
    const uint32_t shining = b.add(scenes::emissive(3));
    for (uint32_t i = 0; i < lamps; ++i)
        b.sphere({0.5f - 0.3f * float(i / 4), 0.8f, -0.6f + 0.3f * float(i % 4)}, 0.05f, shining);
    return b.scene;
}

GpuScene packedFor(const Scene& scene) {
    return packScene(scene, buildWideBvh(scene));
}

float probabilityOfSky(const LightTable& lights) {
    return structureAt<gpu::LightEntry>(lights.table, lights.ambientNumber).probability;
}

/// The probability of each light as one group's tree picks it, were all lights as near and turned
/// alike.
std::vector<double> powersOf(const LightTable& lights) {
    std::vector<double> power;
    for (uint32_t i = 0; i < 2 * lights.count; ++i) {
        const Row row = lights.table[lights.count + i];
        power.push_back(std::bit_cast<float>(
            std::bit_cast<gpu::LightNode>(std::array{row, Row{}}).radiusAndPower << 16));
    }
    return power;
}

TEST(PickedLights, ASkyBehindWallsIsLeftToFewSamples) {
    GpuScene closed = packedFor(roomWithLamps(0, 3));
    ASSERT_EQ(closed.lights.choice, LightChoice::Power);
    EXPECT_GT(probabilityOfSky(closed.lights), 0.99);
    const Scene scene = roomWithLamps(0, 3);
    const HowLightsArePicked how = howToPick(scene, closed, kRoomView, false);
    EXPECT_EQ(how.choice, LightChoice::Power);
    ASSERT_EQ(how.factors.size(), 4u);
    EXPECT_TRUE(pickBy(closed.lights, how));
    // A thirty-second of what it had.
    EXPECT_GT(probabilityOfSky(closed.lights), 0.02);
    EXPECT_LT(probabilityOfSky(closed.lights), 0.06);
    EXPECT_TRUE(pickBy(closed.lights, {closed.lights.weighed->plain})) << "another camera";
    EXPECT_EQ(closed.lights.table, packedFor(scene).lights.table);
    EXPECT_FALSE(pickBy(closed.lights, {closed.lights.weighed->plain}));
}

/// Lamps whose samples take long, behind glass, beside a sky of which nothing arrives. The sky's
/// rays are the shortest, so that it would have a large share of the samples.
TEST(PickedLights, NoLightIsPickedInPlaceOfOneThatIsHidden) {
    GpuScene closed = packedFor(roomWithLamps(0, 3));
    const uint32_t count = closed.lights.count, sky = closed.lights.ambientNumber;
    std::vector<KnownLight> known(count, {.sent = 1, .arrived = 0.5, .segments = 4, .places = 500});
    known[sky] = {.sent = 1, .arrived = 0, .segments = 1, .places = 100};
    EXPECT_EQ(bestPicks(*closed.lights.weighed, known, sky).none, 0) << "too few places say so";
    known[sky].places = 500;
    known[sky].arrived = 0.01;
    EXPECT_EQ(bestPicks(*closed.lights.weighed, known, sky).none, 0) << "it is seen";
    known[sky].arrived = 0;
    const HowLightsArePicked how = bestPicks(*closed.lights.weighed, known, sky);
    EXPECT_GT(how.none, 0.25);
    pickBy(closed.lights, how);
    ASSERT_EQ(closed.lights.entries, count + 1);
    EXPECT_EQ(closed.lights.table.size(), 2 * (count + 1));
    double sum = 0;
    for (uint32_t i = 0; i <= count; ++i)
        sum += structureAt<gpu::LightEntry>(closed.lights.table, i).probability;
    EXPECT_EQ(structureAt<gpu::LightEntry>(closed.lights.table, count).probability, 0);
    EXPECT_NEAR(sum, 1 - how.none, 0.1) << "by rounding to quarters of powers of two";
    // The columns pick each number as often as it says.
    std::vector<double> picked(count + 1, 0.0);
    for (uint32_t i = 0; i <= count; ++i) {
        const auto column = structureAt<gpu::AliasColumn>(closed.lights.table, count + 1 + i);
        picked[i] += double(column.threshold) / (count + 1);
        picked[column.alias] += (1 - double(column.threshold)) / (count + 1);
    }
    for (uint32_t i = 0; i < count; ++i)
        EXPECT_NEAR(picked[i], structureAt<gpu::LightEntry>(closed.lights.table, i).probability,
                    1e-6);
    EXPECT_NEAR(picked[count], 1 - sum, 1e-6);
    pickBy(closed.lights, {closed.lights.weighed->plain});
    EXPECT_EQ(closed.lights.entries, count) << "another camera";
}

/// Light comes through a curtain of which most is not there.
TEST(PickedLights, ASkyBehindAVeilKeepsItsSamples) {
    scenes::SceneMaker b;
    b.scene = roomWithLamps(1, 3);
    Material veil = scenes::diffuse(0.6f);
    veil.alphaMode = AlphaMode::Blend;
    veil.opacity = 0.2f;
    b.quad({-0.95f, -1, -1}, {0, 2, 0}, {0, 0, 2}, b.add(veil));
    const GpuScene scene = packedFor(b.scene);
    const HowLightsArePicked how = howToPick(b.scene, scene, kRoomView, false);
    if (!how.factors.empty()) {
        EXPECT_GT(how.factors[scene.lights.ambientNumber], 0.5);
    }
    b.scene.materials.back().alphaMode = AlphaMode::Opaque;
    const GpuScene dark = packedFor(b.scene);
    EXPECT_LT(howToPick(b.scene, dark, kRoomView, false).factors.at(dark.lights.ambientNumber),
              0.3);
}

TEST(PickedLights, AreAsPackedWhereAllOfThemArrive) {
    scenes::SceneMaker b;
    const uint32_t white = b.add(scenes::diffuse(0.6f));
    b.quad({-1, -1, -1}, {0, 0, 2}, {2, 0, 0}, white);
    const uint32_t shining = b.add(scenes::emissive(3));
    for (const float x : {-0.5f, 0.0f, 0.5f})
        b.sphere({x, 1, 0}, 0.1f, shining);
    const GpuScene floor = packedFor(b.scene);
    const HowLightsArePicked how =
        howToPick(b.scene, floor, lookingAt({0, 0.5, 1.5}, {0, -1, 0}, 0.5), false);
    EXPECT_EQ(how.choice, LightChoice::Tree);
    EXPECT_TRUE(how.factors.empty());
}

TEST(PickedLights, ManyLampsBesideAHiddenSkyAreToldApartByATree) {
    const Scene scene = roomWithLamps(0, 9);
    GpuScene closed = packedFor(scene);
    EXPECT_EQ(closed.lights.choice, LightChoice::Power);
    EXPECT_EQ(closed.lights.groups, 0u) << "no tree in the kernel";
    const HowLightsArePicked how = howToPick(scene, closed, kRoomView, false);
    EXPECT_EQ(how.choice, LightChoice::Tree);
    EXPECT_TRUE(pickBy(closed.lights, how));
    EXPECT_EQ(closed.lights.groups, 1u << gpu::LIGHT_GROUP_NEAR | 1u << gpu::LIGHT_GROUP_INFINITE);
    EXPECT_EQ(closed.lights.table.size(), 5 * closed.lights.count);
}

/// A lamp in a cupboard, which nothing that is seen is lit by.
TEST(PickedLights, ALampBehindWallsIsLeftToFewSamples) {
    scenes::SceneMaker b;
    b.scene = roomWithLamps(0, 2);
    b.scene.environment.reset();
    const uint32_t white = b.add(scenes::diffuse(0.6f)), bright = b.add(scenes::emissive(300));
    b.box({0.3f, -0.9f, -0.9f}, {0.8f, -0.4f, -0.4f}, white);
    b.sphere({0.55f, -0.65f, -0.65f}, 0.1f, bright);
    GpuScene scene = packedFor(b.scene);
    ASSERT_EQ(scene.lights.choice, LightChoice::Tree);
    uint32_t hidden = 0; // the brightest
    for (uint32_t i = 0; i < scene.lights.count; ++i)
        if (scene.lights.weighed->bounds[i].power > scene.lights.weighed->bounds[hidden].power)
            hidden = i;
    const HowLightsArePicked how = howToPick(b.scene, scene, kRoomView, false);
    ASSERT_EQ(how.factors.size(), 3u);
    for (uint32_t i = 0; i < 3; ++i)
        if (i != hidden) {
            EXPECT_LT(how.factors[hidden], 0.3 * how.factors[i]);
        }
}

TEST(PickedLights, TreesHoldThePowersThatTheyAreGiven) {
    const Scene scene = roomWithLamps(0, 7);
    GpuScene room = packedFor(scene);
    pickBy(room.lights, {LightChoice::Tree});
    const std::vector<double> plain = powersOf(room.lights);
    std::vector<double> factors;
    for (uint32_t i = 0; i < room.lights.count; ++i)
        factors.push_back(i + 1.0);
    pickBy(room.lights, {LightChoice::Tree, factors});
    const std::vector<double> given = powersOf(room.lights);
    uint32_t first = 0;
    for (const uint32_t count : room.lights.lightsInGroup) {
        std::vector<double> sum(2 * size_t(count));
        for (uint32_t node = 2 * count; node-- > 1;) {
            const uint32_t number = first + node - count;
            if (node >= count)
                sum[node] = room.lights.weighed->bounds[number].power * factors[number];
            else
                sum[node] = sum[2 * node] + sum[2 * node + 1];
            EXPECT_GE(given[2 * first + node], sum[node]) << node;
            EXPECT_LE(given[2 * first + node], sum[node] * (1 + 0x1p-6)) << node;
        }
        if (count > 0) {
            EXPECT_NE(given[2 * first + 1], plain[2 * first + 1]);
        }
        first += count;
    }
}

class PickedLight : public DeviceTest {
  protected:
    /// how: as packed, if there is none.
    Film pictureOf(const Scene& loaded, const std::optional<HowLightsArePicked>& how,
                   uint32_t seed) {
        RenderSettings settings;
        settings.area.width = 48, settings.area.height = 36;
        settings.budget.mostSamplesPerPixel = 256;
        settings.estimator.maxBounces = 3;
        settings.estimator.seed = seed;
        GpuScene scene =
            packScene(loaded, buildWideBvh(loaded), lightSelection(settings.estimator));
        EXPECT_TRUE(scene.lights.weighed);
        if (how) pickBy(scene.lights, *how);
        VulkanBackend backend(testDevice(), scene, kRoomView, settings);
        return render(backend, settings);
    }
};

/// Light samples know how likely lights are to be picked, and share what bounces find by that.
TEST_F(PickedLight, HasNoBiasForAnyFactors) {
    Scene scene = roomWithLamps(1, 4);
    scene.environment->strength = 1;
    const Film plain = pictureOf(scene, {}, 1);
    const std::vector<double> any = {0.1, 7, 0.5, 2, 30};
    expectAgreement(plain, pictureOf(scene, {{LightChoice::Power, any}}, 2), "an alias table");
    expectAgreement(plain, pictureOf(scene, {{LightChoice::Power, any, 3}}, 4),
                    "an alias table by which some samples take no light");
    expectAgreement(plain, pictureOf(scene, {{LightChoice::Tree, any}}, 3), "a tree");
}

/// Half of the samples take no light, and say so.
TEST_F(PickedLight, TellsOfSamplesThatTakeNone) {
    RenderSettings settings;
    settings.area.width = 48, settings.area.height = 36;
    const Scene loaded = roomWithLamps(0, 3);
    GpuScene scene = packScene(loaded, buildWideBvh(loaded), lightSelection(settings.estimator));
    pickBy(scene.lights, {LightChoice::Power, std::vector<double>(4, 1), 1});
    VulkanBackend backend(testDevice(), scene, kRoomView, settings);
    int none = 0, all = 0;
    for (uint32_t sample = 0; sample < 16; ++sample) {
        const RecordedPath path = backend.record(1000, sample);
        for (const RecordedVertex& v : path.vertices)
            for (const RecordedLight& l : v.lights) {
                ++all;
                if (l.kind != kNoLight) continue;
                ++none;
                EXPECT_EQ(l.fate, RecordedLight::Fate::BringsNothing);
                EXPECT_EQ(l.primitive, kNotNamed);
            }
    }
    EXPECT_GT(none, all / 4);
    EXPECT_LT(none, all - all / 4);
}

/// Where a sky outshines lamps and does not arrive, and with it all but a few of the samples.
TEST_F(PickedLight, HasLessNoiseBehindClosedWindows) {
    const Scene scene = roomWithLamps(0, 4);
    const GpuScene closed = packedFor(scene);
    const HowLightsArePicked how = howToPick(scene, closed, kRoomView, false);
    const auto variance = [](const Film& film) {
        double sum = 0;
        for (const PixelStatistics& p : film.pixels)
            sum += p.m2.y / (double(p.count) - 1);
        return sum;
    };
    const Film plain = pictureOf(scene, {}, 1), picked = pictureOf(scene, how, 2);
    expectAgreement(plain, picked, "a closed room");
    EXPECT_LT(variance(picked), 0.1 * variance(plain));
}

} // namespace
} // namespace stromboli
