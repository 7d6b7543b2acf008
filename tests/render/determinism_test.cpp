// A scene, settings and a device give the same bytes, however the work is cut.
#include "source_dir.h"
#include "tests/render/device_render.hpp"
#include "tests/render/film_checks.hpp"
#include "tests/support/device_fixture.hpp"

#include <gtest/gtest.h>

namespace stromboli {
namespace {

using namespace test;

const std::filesystem::path kLibrary =
    std::filesystem::path(STROMBOLI_SOURCE_DIR) / "scene" / "library";

RenderSettings settings() {
    RenderSettings s;
    s.area.width = 61, s.area.height = 37; // no multiples of a tile or a workgroup
    s.budget.mostSamplesPerPixel = 8;
    s.estimator.maxBounces = 6;
    s.estimator.lightSamples = 2;
    return s;
}

class Determinism : public DeviceTest {
  protected:
    Scene scene = loadScene(kLibrary / "cornell_mirror_glass.dae");

    Film renderWith(const RenderSettings& s, const KernelTuning& tuning = {}) {
        const Camera camera =
            makeCamera(scene, CameraChoice::Automatic, s.area.width, s.area.height);
        return renderOnDevice(testDevice(), scene, camera, s, tuning);
    }
};

TEST_F(Determinism, TwoRuns) {
    expectSameBytes(renderWith(settings()), renderWith(settings()));
}

TEST_F(Determinism, AnotherSeedIsAnotherPicture) {
    RenderSettings s = settings();
    const Film a = renderWith(s);
    s.estimator.seed = 1;
    const Film b = renderWith(s);
    size_t same = 0;
    for (size_t i = 0; i < a.pixels.size(); ++i)
        same += sameBytes(a.pixels[i], b.pixels[i]);
    EXPECT_LT(same, a.pixels.size() / 2); // black background is the same
}

TEST_F(Determinism, ItemsPerDispatch) {
    const Film whole = renderWith(settings());
    for (uint32_t items : {7u, 100u, 4096u})
        expectSameBytes(whole, renderWith(settings(), {.itemsPerDispatch = items}));
}

TEST_F(Determinism, OnePixelAWorkList) {
    RenderSettings s = settings();
    s.budget.mostSamplesPerPixel = 2;
    s.area.crop = {20, 10, 16, 12};
    expectSameBytes(renderWith(s), renderWith(s, {.itemsPerDispatch = 1}));
}

TEST_F(Determinism, NumberOfLanes) {
    // One group that takes all pixels in turn; lanes that fill no group; more lanes than items.
    const Film whole = renderWith(settings());
    for (uint32_t lanes : {8u, 100u, 1000u, 1000000u})
        expectSameBytes(whole, renderWith(settings(), {.lanes = lanes}));
    expectSameBytes(whole, renderWith(settings(), {.lanes = 1000, .itemsPerDispatch = 64}));
}

TEST_F(Determinism, WhateverThreadsTheDriverIsBelievedToHave) {
    const Film whole = renderWith(settings());
    for (uint32_t threads : {0u, 1u, 3u, 1000u})
        for (uint32_t lanes : {100u, 2000u})
            expectSameBytes(whole,
                            renderWith(settings(), {.lanes = lanes, .driverThreads = threads}));
}

TEST_F(Determinism, LengthOfDispatches) {
    // A few loop iterations a dispatch: paths are suspended and resumed at nearly every bounce.
    const Film whole = renderWith(settings());
    for (uint32_t iterations : {1u, 7u, 50u})
        expectSameBytes(whole, renderWith(settings(), {.fixedIterations = iterations}));
}

/// What a sample weighs is found again when its path is taken up.
TEST_F(Determinism, LengthOfDispatchesWithWeightsOfSamples) {
    RenderSettings s = settings();
    s.estimator.filter = PixelFilter::Lanczos;
    const Film whole = renderWith(s);
    for (uint32_t iterations : {1u, 7u})
        expectSameBytes(whole, renderWith(s, {.fixedIterations = iterations}));
}

/// Other sizes and numbers of steps, each of which is a kernel to compile, are among the hard cases
/// ("cuts").
TEST_F(Determinism, WorkgroupSizeAndTraversalSteps) {
    const Film whole = renderWith(settings());
    expectSameBytes(whole, renderWith(settings(), {.workgroupSize = 100}));
    for (uint32_t steps : {1u, 16u})
        expectSameBytes(whole, renderWith(settings(), {.traversalSteps = steps}));
}

TEST_F(Determinism, SceneFetch) {
    RenderSettings weighted = settings();
    weighted.estimator.filter = PixelFilter::Mitchell;
    for (const RenderSettings& s : {settings(), weighted})
        expectSameBytes(renderWith(s, {.texelFetch = true}), renderWith(s, {.texelFetch = false}));
}

TEST_F(Determinism, CropIsThePartOfTheWhole) {
    RenderSettings s = settings();
    const Film whole = renderWith(s);
    s.area.crop = {13, 5, 20, 17};
    const Film part = renderWith(s);
    ASSERT_EQ(part.pixels.size(), 20u * 17u); // nothing is kept of the rest
    for (uint32_t y = 0; y < part.height; ++y)
        for (uint32_t x = 0; x < part.width; ++x)
            EXPECT_TRUE(sameBytes(whole.at(13 + x, 5 + y), part.at(x, y)));
}

TEST_F(Determinism, AdaptiveInSmallDispatches) {
    RenderSettings s = settings();
    s.budget.mostSamplesPerPixel = 200;
    s.budget.adaptive = {.enabled = true, .batch = 16, .tolerance = 0.1};
    expectSameBytes(renderWith(s),
                    renderWith(s, {.lanes = 64, .itemsPerDispatch = 128, .fixedIterations = 9}));
}

TEST_F(Determinism, OddPictureSizes) {
    for (const auto& [width, height] : {std::pair{1u, 1u}, {1u, 17u}, {7u, 13u}, {300u, 1u}}) {
        RenderSettings s = settings();
        s.area.width = width, s.area.height = height;
        s.budget.mostSamplesPerPixel = 3;
        const Film film = renderWith(s);
        for (const PixelStatistics& p : film.pixels)
            EXPECT_EQ(p.taken(), 3u);
    }
}

} // namespace
} // namespace stromboli
