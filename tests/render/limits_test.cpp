// What happens at the device's limits: an error that says so, never a wrong picture.
#include "host/core/error.hpp"
#include "host/vulkan/instance.hpp"
#include "source_dir.h"
#include "tests/render/device_render.hpp"
#include "tests/support/device_fixture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace stromboli {
namespace {

using namespace test;

class Limits : public DeviceTest {};

std::string messageOf(const std::function<void()>& action) {
    try {
        action();
    } catch (const DeviceError& error) {
        return error.what();
    }
    return "no error";
}

TEST_F(Limits, LostDeviceIsAClearError) {
    EXPECT_THAT(messageOf([] { vulkan::check(VK_ERROR_DEVICE_LOST, "run the path kernel"); }),
                testing::AllOf(testing::HasSubstr("run the path kernel"),
                               testing::HasSubstr("device lost")));
}

TEST_F(Limits, LoopOverflowIsReportedNotRendered) {
    // On llvmpipe a surface with 1024 samples of each of 16 lights needs more loop passes than a
    // dispatch has; elsewhere there is no such limit to meet.
    if (!testDevice().description().isCpu()) GTEST_SKIP() << "the limit is llvmpipe's";
    Scene scene =
        loadScene(std::filesystem::path(STROMBOLI_SOURCE_DIR) / "scene/library/light_area.dae");
    RenderSettings s;
    s.area.width = 8, s.area.height = 8, s.budget.mostSamplesPerPixel = 1,
    s.estimator.maxBounces = 1;
    s.estimator.directLight = DirectLight::Hemisphere;
    s.estimator.lightSamples = 1024 * 16;
    const Camera camera = makeCamera(scene, CameraChoice::Automatic, s.area.width, s.area.height);
    EXPECT_THAT(messageOf([&] { renderOnDevice(testDevice(), scene, camera, s); }),
                testing::HasSubstr("loop iterations"));
}

TEST_F(Limits, ManyLightsFitTheLoopLimit) {
    // 600 lights, each sampled at every surface.
    Scene scene =
        loadScene(std::filesystem::path(STROMBOLI_SOURCE_DIR) / "scene/library/light_point.dae");
    const Light light = scene.lights.at(0);
    for (int i = 1; i < 600; ++i) {
        scene.lights.push_back(light);
        scene.lights.back().position.x += 0.001f * float(i);
    }
    RenderSettings s;
    s.area.width = 8, s.area.height = 8, s.budget.mostSamplesPerPixel = 2,
    s.estimator.maxBounces = 3;
    const Camera camera = makeCamera(scene, CameraChoice::Automatic, s.area.width, s.area.height);
    for (const PixelStatistics& p : renderOnDevice(testDevice(), scene, camera, s).pixels)
        EXPECT_EQ(p.count, 2u);
}

TEST_F(Limits, FilmLargerThanOneBindingIsSplit) {
    // 128 MiB of pixel states are 2 M pixels: this picture needs two segments on lavapipe. Only
    // its last rows are looked at, to see that the second segment is the right part.
    Scene scene =
        loadScene(std::filesystem::path(STROMBOLI_SOURCE_DIR) / "scene/library/cornell_boxes.dae");
    RenderSettings s;
    s.area.width = 2048, s.area.height = 1100, s.budget.mostSamplesPerPixel = 1,
    s.estimator.maxBounces = 0;
    const Camera camera = makeCamera(scene, CameraChoice::Automatic, s.area.width, s.area.height);
    const Film whole = renderOnDevice(testDevice(), scene, camera, s);
    s.area.crop = {900, 1000, 200, 100};
    const Film part = renderOnDevice(testDevice(), scene, camera, s);
    for (uint32_t y = 0; y < 100; ++y)
        for (uint32_t x = 0; x < 200; ++x)
            ASSERT_EQ(whole.at(900 + x, 1000 + y).mean, part.at(x, y).mean) << x << " " << y;
}

} // namespace
} // namespace stromboli
