// Guided light samples in pictures: without bias for any guide, the same bytes however the work is
// cut, less noise where light comes through a window, and none of it where a scene lies open.
#include "host/bvh/wide_layout.hpp"
#include "host/core/color.hpp"
#include "host/core/random.hpp"
#include "host/kernel/light_notes.hpp"
#include "host/kernel/light_table.hpp"
#include "host/kernel/sky_picture.hpp"
#include "host/render/sampling_session.hpp"
#include "shaders/shared/medium_types.h"
#include "tests/kernel/window_room.hpp"
#include "tests/render/device_render.hpp"
#include "tests/support/device_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <vector>

namespace stromboli {
namespace {

using namespace test;

/// A guide that knows nothing: cuts anywhere, and tiles that differ hundredfold.
LightGuide garbage(const EnvironmentTable& environment) {
    Random random(17);
    std::vector<gpu::GuideNode> nodes(gpu::GUIDE_NODES);
    for (gpu::GuideNode& n : nodes)
        n = {random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1),
             random.below(6) | random.below(6) << 8 | random.below(6) << 16};
    std::vector<std::vector<double>> probabilities(gpu::GUIDE_CELLS);
    for (std::vector<double>& cell : probabilities) {
        double sum = 0;
        for (const double byWeight : environment.tileProbability)
            sum += cell.emplace_back(byWeight * std::pow(10.0, random.uniform(-1, 1)));
        for (double& p : cell)
            p /= sum;
    }
    return {guideRows(nodes, probabilities, environment), 100};
}

class GuidedLight : public DeviceTest {
  protected:
    GuidedLight() {
        settings_.area.width = 48, settings_.area.height = 36;
        settings_.budget.mostSamplesPerPixel = 64;
        settings_.estimator.maxBounces = 3;
        settings_.estimator.guidesLight = true;
    }

    /// given: the guide, in place of what is learnt.
    Film pictureOf(const Scene& loaded, const KernelTuning& tuning = {},
                   const std::optional<LightGuide>& given = {}) {
        GpuScene scene =
            packScene(loaded, buildWideBvh(loaded), lightSelection(settings_.estimator));
        scene.guide = given ? given : guideThatPays(loaded, scene, kRoomView, false);
        VulkanBackend backend(testDevice(), scene, kRoomView, settings_, tuning);
        isGuided_ = backend.features()[SPEC_GUIDES_LIGHT] != 0;
        return render(backend, settings_);
    }

    Film unguided(const Scene& scene) {
        settings_.estimator.guidesLight = false;
        Film film = pictureOf(scene);
        settings_.estimator.guidesLight = true;
        return film;
    }

    RenderSettings settings_;
    bool isGuided_ = false; ///< the last picture
};

/// Independent samples, so that variances are right.
TEST_F(GuidedLight, AnyGuideHasNoBias) {
    settings_.estimator.sampler = Sampler::Independent;
    settings_.budget.mostSamplesPerPixel = 192;
    settings_.estimator.directLight = DirectLight::Lights; // bounces find nothing
    const auto expectNoBias = [&](const Scene& scene, const std::string& what) {
        settings_.estimator.seed = 0;
        const Film plain = unguided(scene);
        settings_.estimator.seed = 1;
        const Film guided = pictureOf(scene, {}, garbage(packEnvironment(*scene.environment)));
        ASSERT_TRUE(isGuided_);
        expectAgreement(plain, guided, what);
    };
    expectNoBias(roomWithWindow(1), "a room");
    Scene narrow = roomWithWindow(1); // tiles that its edges cut off
    narrow.environment->width = 33, narrow.environment->height = 17;
    narrow.environment->radiance.resize(size_t(33) * 17);
    expectNoBias(narrow, "a sky of 33 x 17 texels");
    settings_.budget.mostSamplesPerPixel = 48;
    settings_.estimator.directLight = DirectLight::Mis;
    settings_.estimator.branches = 4;
    settings_.estimator.lightSamples = 2;
    settings_.estimator.lightChoice = LightChoice::Each;
    expectNoBias(roomWithMore(1), "rough glass, each of two lights, branches");
    settings_.estimator.lightChoice = LightChoice::Automatic;
    settings_.estimator.branches = 1;
    expectNoBias(roomWithMore(4), "rough glass, a tree of lights");
}

/// Notes say that light arrives where their direction leaves by the window, and nowhere else.
TEST(LightNotes, AreOfWhatComesThroughTheWindow) {
    constexpr float kWindow = 0.7f;
    const auto notesOf = [](const Scene& scene) {
        const GpuScene packed = packScene(scene, buildWideBvh(scene));
        return noteLightSamples(scene, packed, kRoomView, false);
    };
    const std::vector<LightNote> notes = notesOf(roomWithWindow(kWindow));
    ASSERT_GT(notes.size(), 20000u);
    size_t arrived = 0;
    for (const LightNote& n : notes) {
        const glm::vec3 at = n.position + (-1 - n.position.x) / n.direction.x * n.direction;
        const float beside = std::max(std::abs(at.y), std::abs(at.z)) - kWindow / 2;
        if (std::abs(beside) < 1e-3f) continue; // its edge
        const bool leaves = n.direction.x < 0 && n.position.x > -0.999f && beside < 0;
        const float cosine = glm::dot(n.direction, n.normal);
        EXPECT_NEAR(n.value, leaves ? std::max(cosine, 0.0f) : 0.0f, 1e-5f);
        arrived += n.value > 0;
    }
    EXPECT_GT(arrived, 200u);
    for (const LightNote& n : notesOf(roomWithWindow(0)))
        EXPECT_EQ(n.value, 0) << "a closed room";
}

TEST(LightNotes, AreNotAskedForWhereMediaScatter) {
    const Scene scene = roomWithWindow(0.7f);
    GpuScene packed = packScene(scene, buildWideBvh(scene));
    EXPECT_TRUE(guideThatPays(scene, packed, kRoomView, false));
    packed.media |= gpu::MEDIA_SCATTER;
    EXPECT_FALSE(guideThatPays(scene, packed, kRoomView, false));
}

class SkyPictureOf : public ::testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(SkyPicture, SkyPictureOf, ::testing::Bool(), [](const auto& rows) {
    return std::string(rows.param ? "RowsThatReachThePoles" : "RowsHalfARowAway");
});

/// As often in each texel as its weight says: chi-squared over the texels that 20 directions or
/// more are expected in, beyond the bound once in 10,000.
TEST_P(SkyPictureOf, HasTheDensityOfTheSkysWeight) {
    constexpr int kCount = 100000;
    Environment sky = roughSky();
    sky.rotation = 0.7f;
    sky.rowsReachPoles = GetParam();
    const EnvironmentTable table = packEnvironment(sky);
    ASSERT_GT(table.light.tileShift, 0u) << "tiles of several texels";
    EnvironmentTable texels = table; // each a tile
    texels.light.tileShift = 0, texels.light.tilesAcross = sky.width;
    const SkyPicture picture(table);
    Random random(3);
    std::vector<int> met(sky.radiance.size());
    for (int i = 0; i < kCount; ++i)
        ++met[tileOf(texels, glm::vec3(picture.sample(random)))];
    const auto weight = [&](size_t t) {
        // Of rows at a pole no texel is met 20 times.
        const double row = double(t / sky.width),
                     polar = GetParam() ? row / (sky.height - 1) : (row + 0.5) / sky.height;
        return luminance(glm::dvec3(sky.radiance[t])) * std::sin(std::numbers::pi * polar);
    };
    double sum = 0, chiSquare = 0;
    for (size_t t = 0; t < met.size(); ++t)
        sum += weight(t);
    int degrees = 0;
    for (size_t t = 0; t < met.size(); ++t) {
        const double expected = kCount * weight(t) / sum;
        if (expected < 20) continue;
        chiSquare += std::pow(met[t] - expected, 2) / expected;
        ++degrees;
    }
    ASSERT_GT(degrees, 500);
    EXPECT_LT(chiSquare, degrees + 3.8 * std::sqrt(2.0 * degrees));
}

/// Also where half of its row lies beyond a pole.
TEST_P(SkyPictureOf, GoesToTheTexelThatShines) {
    for (const uint32_t row : {0u, 3u, 7u}) {
        Environment sky{"", 16, 8, std::vector<glm::vec3>(16 * 8, glm::vec3(0)), 1, 0.7f};
        sky.radiance[row * 16 + 5] = glm::vec3(1);
        sky.rowsReachPoles = GetParam();
        const EnvironmentTable table = packEnvironment(sky); // each texel is a tile
        const SkyPicture picture(table);
        Random random(3);
        for (int i = 0; i < 1000; ++i)
            ASSERT_EQ(tileOf(table, glm::vec3(picture.sample(random))), row * 16 + 5);
    }
}

TEST_F(GuidedLight, LearnsWhereAWindowIs) {
    const Scene scene = roomWithWindow(0.7f);
    const Film plain = unguided(scene);
    settings_.estimator.seed = 1;
    const Film guided = pictureOf(scene);
    ASSERT_TRUE(isGuided_);
    double before = 0, after = 0;
    for (size_t i = 0; i < plain.pixels.size(); ++i) {
        before += plain.pixels[i].m2.y;
        after += guided.pixels[i].m2.y;
    }
    EXPECT_LT(after, before / 1.5);
}

/// A picture does not depend on the one before it, guided or not.
TEST_F(GuidedLight, DoesNotDependOnThePictureBefore) {
    const Scene loaded = roomWithWindow(0.7f);
    settings_.budget.mostSamplesPerPixel = 2;
    GpuScene scene = packScene(loaded, buildWideBvh(loaded), lightSelection(settings_.estimator));
    scene.guide = guideThatPays(loaded, scene, kRoomView, false);
    RenderSettings unguided = settings_;
    unguided.estimator.guidesLight = false;
    VulkanBackend backend(testDevice(), scene, kRoomView, settings_);
    for (const RenderSettings& other : {unguided, settings_}) {
        backend.setPicture(kRoomView, other);
        const Film after = render(backend, other);
        VulkanBackend fresh(testDevice(), scene, kRoomView, other);
        EXPECT_EQ(fresh.features()[SPEC_GUIDES_LIGHT] != 0, other.estimator.guidesLight);
        EXPECT_TRUE(sameStatistics(render(fresh, other), after));
    }
}

TEST_F(GuidedLight, IsLeftWhereASceneLiesOpen) {
    scenes::SceneMaker b;
    b.quad({-5, -1, -5}, {0, 0, 10}, {10, 0, 0}, b.add(scenes::diffuse(0.6f)));
    b.scene.environment = roughSky();
    const Film plain = unguided(b.scene);
    const Film asked = pictureOf(b.scene);
    EXPECT_FALSE(isGuided_);
    EXPECT_TRUE(sameStatistics(plain, asked));
}

TEST(SeesSkyInPart, WhereRaysLeaveThroughAWindowThatHasNoPane) {
    const auto sees = [](const Scene& scene) {
        return seesSkyInPart(packScene(scene, buildWideBvh(scene)), kRoomView);
    };
    EXPECT_TRUE(sees(roomWithWindow(0.7f)));
    scenes::SceneMaker b;
    b.scene = roomWithWindow(0.7f);
    b.quad({-1, -1, -1}, {0, 2, 0}, {0, 0, 2}, b.add(scenes::diffuse(0)));
    EXPECT_FALSE(sees(b.scene)) << "behind a pane";
    scenes::SceneMaker open;
    open.quad({-5, -1, -5}, {0, 0, 10}, {10, 0, 0}, open.add(scenes::diffuse(0.6f)));
    open.scene.environment = roughSky();
    EXPECT_FALSE(sees(open.scene)) << "under the open sky";
}

TEST_F(GuidedLight, HasTheSameBytesHoweverTheWorkIsCut) {
    const Scene scene = roomWithWindow(0.7f);
    settings_.budget.mostSamplesPerPixel = 4;
    const Film whole = pictureOf(scene);
    ASSERT_TRUE(isGuided_);
    EXPECT_TRUE(sameStatistics(
        whole, pictureOf(scene, {.scheduler = PathScheduler::Wavefront, .lanes = 100})))
        << "the other scheduler";
    EXPECT_TRUE(sameStatistics(whole, pictureOf(scene, {.itemsPerDispatch = 100})))
        << "in short work lists";
    EXPECT_TRUE(sameStatistics(whole, pictureOf(scene, {.texelFetch = false})))
        << "from storage buffers";
    settings_.area.crop = {10, 7, 20, 11};
    const Film part = pictureOf(scene);
    for (uint32_t y = 0; y < 11; ++y)
        for (uint32_t x = 0; x < 20; ++x) {
            const PixelStatistics &a = part.pixels[y * 20 + x],
                                  &b = whole.pixels[(7 + y) * 48 + 10 + x];
            ASSERT_EQ(a.mean, b.mean);
            ASSERT_EQ(a.m2, b.m2);
        }
}

} // namespace
} // namespace stromboli
