// How the kernel runs on a device: what is chosen, and that no choice changes the picture.
#include "host/bvh/wide_layout.hpp"
#include "host/kernel/feelers.hpp"
#include "host/render/sampling_session.hpp"
#include "scene/generate/scene_maker.hpp"
#include "scene/read_scene.hpp"
#include "source_dir.h"
#include "tests/render/device_render.hpp"
#include "tests/support/device_fixture.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace stromboli {
namespace {

using namespace test;

class KernelTuningTest : public DeviceTest {
  protected:
    VulkanBackend backend(const KernelTuning& tuning) {
        return VulkanBackend(testDevice(), scene_, camera_, settings_, tuning);
    }

    static RenderSettings settings() {
        RenderSettings s;
        s.area.width = 61, s.area.height = 37;
        s.budget.mostSamplesPerPixel = 8;
        s.estimator.maxBounces = 5;
        return s;
    }

    RenderSettings settings_ = settings();
    Scene loaded_ =
        loadScene(std::filesystem::path(STROMBOLI_SOURCE_DIR) / "scene/library/cornell_boxes.dae");
    GpuScene scene_ = packScene(loaded_, buildWideBvh(loaded_));
    Camera camera_ = makeCamera(loaded_, CameraChoice::Automatic, 61, 37);
};

TEST_F(KernelTuningTest, TheDeviceDecidesWhatIsLeftOpen) {
    const DeviceTuning t = resolve({}, testDevice());
    const bool cpu = testDevice().description().isCpu();
    EXPECT_EQ(t.texelFetch, cpu) << "storage buffer loads are slow on llvmpipe only";
    if (cpu) {
        EXPECT_EQ(t.workgroupSize, testDevice().description().subgroupSize);
    }
    EXPECT_LE(t.workgroupSize, testDevice().limits().maxComputeWorkGroupInvocations);
    EXPECT_EQ(t.lanes % t.workgroupSize, 0u);
    EXPECT_EQ(t.driverThreads > 0, cpu) << "llvmpipe gives each thread as many groups in turn";
    EXPECT_GE(t.traversalSteps, 1u);
    EXPECT_GE(t.itemsPerDispatch, t.lanes);
    EXPECT_FALSE(t.countSteps);
    EXPECT_FALSE(t.everythingOn);
}

/// What the host counts with some hundred rays is about what the kernel's rays visit.
TEST_F(KernelTuningTest, RecordsOfARayAreKnownBeforehand) {
    VulkanBackend counting = backend({.countSteps = true});
    render(counting, settings_);
    const double visited = double(counting.steps().busy) / double(counting.counters().rays);
    EXPECT_NEAR(visitsOfRay(scene_.bvh, camera_).records, visited, 0.2 * visited);
}

/// Steps that are asked for are those of all kernels.
TEST_F(KernelTuningTest, StepsFitRaysUnlessTheyAreGiven) {
    const bool cpu = testDevice().description().isCpu();
    EXPECT_EQ(resolve({}, testDevice()).stepsFitRays, cpu);
    EXPECT_FALSE(resolve({.traversalSteps = 5}, testDevice()).stepsFitRays);
}

TEST_F(KernelTuningTest, WhatIsGivenIsTaken) {
    const DeviceTuning t = resolve({.texelFetch = false,
                                    .workgroupSize = 24,
                                    .traversalSteps = 3,
                                    .lanes = 7,
                                    .driverThreads = 9,
                                    .itemsPerDispatch = 5,
                                    .countSteps = true,
                                    .everythingOn = true},
                                   testDevice());
    EXPECT_FALSE(t.texelFetch);
    EXPECT_TRUE(resolve({.texelFetch = true}, testDevice()).texelFetch);
    EXPECT_EQ(t.workgroupSize, 24u);
    EXPECT_EQ(t.traversalSteps, 3u);
    EXPECT_EQ(t.lanes, 7u);
    EXPECT_EQ(t.driverThreads, 9u);
    EXPECT_EQ(t.itemsPerDispatch, 5u);
    EXPECT_TRUE(t.countSteps);
    EXPECT_TRUE(t.everythingOn);
}

TEST_F(KernelTuningTest, EverythingOnIsTheSamePicture) {
    VulkanBackend specialised = backend({}), everything = backend({.everythingOn = true});
    EXPECT_NE(specialised.features(), everything.features());
    EXPECT_TRUE(sameStatistics(render(specialised, settings_), render(everything, settings_)));
}

/// Spheres that wait to be tested are met all the same, also several in a row, and where a step
/// meets none.
TEST_F(KernelTuningTest, SpheresThatWaitAreMet) {
    scenes::SceneMaker b;
    b.scene = loaded_;
    Random random(5);
    const uint32_t blue = b.add(scenes::diffuse(0.4f)), shine = b.add(scenes::emissive(2));
    for (int i = 0; i < 60; ++i)
        b.sphere(
            {random.uniform(-0.3f, 0.3f), random.uniform(0.1f, 0.9f), random.uniform(-0.3f, 0.3f)},
            random.uniform(0.02f, 0.12f), i % 7 == 0 ? shine : blue);
    const auto pictureWith = [&](double spheres) {
        GpuScene packed = packScene(b.scene, buildWideBvh(b.scene));
        packed.ofRay = {8, spheres};
        VulkanBackend device(testDevice(), packed, camera_, settings_);
        EXPECT_EQ(device.features()[SPEC_SPHERES_WAIT], spheres < 1 ? 1u : 0u);
        return render(device, settings_);
    };
    EXPECT_TRUE(sameStatistics(pictureWith(0.1), pictureWith(2)));
}

TEST_F(KernelTuningTest, CountsStepsWithoutChangingThePicture) {
    VulkanBackend plain = backend({}), counting = backend({.countSteps = true});
    EXPECT_TRUE(sameStatistics(render(plain, settings_), render(counting, settings_)));
    EXPECT_EQ(plain.steps().all, 0u);
    const StepCounters steps = counting.steps();
    EXPECT_GT(steps.busy, counting.counters().rays) << "a ray visits the root, at least";
    EXPECT_LE(steps.busy, steps.all);
    EXPECT_GT(double(steps.busy), 0.25 * double(steps.all)) << "lanes are idle most of the time";
}

/// Groups that go by the iterations of all lanes end when these have had what the pace allows, not
/// at the limit of their own, and look at the count only now and then.
TEST_F(KernelTuningTest, DispatchesAreAsLongAsThePaceAllows) {
    if (!testDevice().description().isCpu()) GTEST_SKIP() << "no shared count on a GPU";
    settings_.budget.mostSamplesPerPixel = 64;
    const auto iterationsPerDispatch = [&](double targetSeconds) {
        constexpr uint32_t steps = 4, lanes = 64;
        VulkanBackend b = backend({.traversalSteps = steps,
                                   .lanes = lanes,
                                   .driverThreads = 2,
                                   .targetSeconds = targetSeconds,
                                   .countSteps = true});
        uint32_t dispatches = 0;
        render(b, settings_, [&](const RenderProgress&) { return ++dispatches > 0; });
        return double(b.steps().all) / steps / lanes / dispatches;
    };
    EXPECT_LT(iterationsPerDispatch(1e-9), 200); // the least pace, 16, but no look before 64
    EXPECT_GT(iterationsPerDispatch(10), 800);   // 64, and four times as many each time
}

/// A lane whose pixel is done waits until an eighth of the others' are, not all.
TEST_F(KernelTuningTest, LanesSeldomWaitForAnotherPixel) {
    const auto busyShare = [&](uint32_t samples) {
        settings_.budget.mostSamplesPerPixel = samples;
        VulkanBackend b = backend({.lanes = 256, .countSteps = true});
        render(b, settings_);
        return double(b.steps().busy) / double(b.steps().all);
    };
    EXPECT_GT(busyShare(2), 0.9 * busyShare(64));
}

/// A ray that has passed a layer begins at its origin again, and leaves out what lies before the
/// next one: the steps of a layer grow like the depth of the tree, not like the number of layers.
TEST_F(KernelTuningTest, LayersThatWerePassedAreNotVisitedAgain) {
    const auto stepsOfALayer = [](uint32_t layers) {
        scenes::SceneMaker b;
        Material layer;
        layer.alphaMode = AlphaMode::Blend;
        layer.opacity = 0x1p-24f; // none stops a ray of this picture
        const uint32_t material = b.add(layer);
        for (uint32_t i = 0; i < layers; ++i)
            b.quad({-2, -2, float(i)}, {4, 0, 0}, {0, 4, 0}, material);
        Camera camera;
        camera.position = {0, 0, float(layers)};
        camera.halfWidth = camera.halfHeight = 1 / float(layers);
        RenderSettings s = settings();
        s.area.width = s.area.height = 8;
        s.budget.mostSamplesPerPixel = 1;
        const GpuScene scene = packScene(b.scene, buildWideBvh(b.scene));
        VulkanBackend backend(testDevice(), scene, camera, s, {.countSteps = true});
        render(backend, s);
        return double(backend.steps().busy) / (64.0 * layers);
    };
    // Where layers are visited again, 16 times as many take 12 times as many steps each.
    EXPECT_LT(stepsOfALayer(1024), 5 * stepsOfALayer(64));
}

/// If there is one step a service pass, a lane that has work is busy in every step.
TEST_F(KernelTuningTest, FewerStepsBetweenServicesKeepLanesBusier) {
    VulkanBackend often = backend({.traversalSteps = 1, .countSteps = true});
    VulkanBackend seldom = backend({.traversalSteps = 16, .countSteps = true});
    render(often, settings_), render(seldom, settings_);
    EXPECT_EQ(often.steps().busy, seldom.steps().busy) << "the rays' steps are the rays'";
    EXPECT_LT(often.steps().all, seldom.steps().all);
}

} // namespace
} // namespace stromboli
