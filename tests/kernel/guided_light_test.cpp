// Guided light samples in pictures: without bias for any guide, the same bytes however the work is
// cut, less noise where light comes through a window, and none of it where a scene lies open.
#include "host/bvh/wide_layout.hpp"
#include "host/core/random.hpp"
#include "host/kernel/light_guide.hpp"
#include "host/kernel/light_table.hpp"
#include "host/render/sampling_session.hpp"
#include "tests/kernel/window_room.hpp"
#include "tests/render/device_render.hpp"
#include "tests/support/device_fixture.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace stromboli {
namespace {

using namespace test;

/// A guide that knows nothing: cuts anywhere, and tiles that differ hundredfold.
std::shared_ptr<const LightGuide> garbage(const EnvironmentTable& environment) {
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
    auto guide = std::make_shared<LightGuide>();
    guide->rows = guideRows(nodes, probabilities, environment);
    guide->gain = 100;
    return guide;
}

class GuidedLight : public DeviceTest {
  protected:
    GuidedLight() {
        settings_.area.width = 48, settings_.area.height = 36;
        settings_.budget.mostSamplesPerPixel = 64;
        settings_.estimator.maxBounces = 3;
        settings_.estimator.guidesLight = true;
    }

    Film pictureOf(const Scene& loaded, const KernelTuning& tuning = {}) {
        const GpuScene scene =
            packScene(loaded, buildWideBvh(loaded), lightSelection(settings_.estimator));
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
        const Film guided =
            pictureOf(scene, {.guide = garbage(packEnvironment(*scene.environment))});
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

/// A picture does not depend on the one before it, nor on the crop's size.
TEST_F(GuidedLight, IsLearntAnewForOtherSettings) {
    const Scene loaded = roomWithWindow(0.7f);
    settings_.budget.mostSamplesPerPixel = 2;
    const GpuScene scene =
        packScene(loaded, buildWideBvh(loaded), lightSelection(settings_.estimator));
    RenderSettings other = settings_;
    other.estimator.sampler = Sampler::Independent;
    other.area.crop = {3, 4, 1, 1};
    VulkanBackend backend(testDevice(), scene, kRoomView, settings_);
    backend.setPicture(kRoomView, other);
    const Film after = render(backend, other);
    VulkanBackend fresh(testDevice(), scene, kRoomView, other);
    EXPECT_TRUE(sameStatistics(render(fresh, other), after));
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

/// Learning would take a second kernel and as many paths as four samples of each pixel.
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
