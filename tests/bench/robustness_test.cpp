// The plain kernels that robustness is measured against: they do the same work where plain code is
// good enough, and have its faults where it is not, or they would not be what they are called.
#include "host/bench/plain_kernels.hpp"
#include "host/bench/ray_bench.hpp"
#include "host/kernel/vulkan_backend.hpp"
#include "host/render/render.hpp"
#include "tests/bench/bench_fixtures.hpp"
#include "tests/support/device_fixture.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace stromboli::bench {
namespace {

using test::DeviceTest;
using test::libraryPicture;
using test::LibraryPicture;
using test::testDevice;

std::vector<float> trace(const Scene& scene, const RaySet& set, std::span<const uint32_t> code) {
    const GpuScene gpu = packScene(scene, buildWideBvh(scene));
    DeviceRays device(testDevice(), gpu, rayTuning(testDevice()), code);
    device.load(set);
    return device.distances();
}

bool texelFetch() {
    return rayTuning(testDevice()).kernel.texelFetch;
}

/// Rays through edges may go either way: 1 in 500.
TEST_F(DeviceTest, PlainRayKernelsEndWhereTheRobustOneDoes) {
    const LibraryPicture picture = libraryPicture("cornell_boxes");
    const RaySet set = makeRaySets(picture.scene, picture.camera, picture.settings, 1).bounce;
    const std::vector<float> robust = trace(picture.scene, set, {});
    for (const PlainKernel& plain : plainRayKernels()) {
        const std::vector<float> found = trace(picture.scene, set, plain.code(texelFetch()));
        EXPECT_LE(countDisagreements(set, robust, found), set.rays.size() / 500) << plain.name;
    }
}

/// Moeller and Trumbore's determinant of a triangle with legs of 1e-5 is below the cut-off.
TEST_F(DeviceTest, PlainTrianglesAreLostWhereTheyAreTiny) {
    Scene scene;
    scene.positions = {{0, 0, 0}, {1e-5f, 0, 0}, {0, 1e-5f, 0}};
    scene.triangles.push_back({{0, 1, 2}});
    scene.materials.resize(1);
    scene.instances = {"triangle"};
    const RaySet set{"one", false, {{{2e-6f, 2e-6f, 1}, 10, {0, 0, -1}, 0}}};
    EXPECT_EQ(hitShare(trace(scene, set, {})), 1);
    for (const PlainKernel& plain : plainRayKernels())
        EXPECT_EQ(hitShare(trace(scene, set, plain.code(texelFetch()))),
                  plain.name == "plain boxes" ? 1 : 0)
            << plain.name;
}

double meanOf(const LibraryPicture& p, std::span<const uint32_t> code) {
    KernelTuning tuning;
    tuning.code = code;
    const GpuScene gpu = packScene(p.scene, buildWideBvh(p.scene));
    VulkanBackend backend(testDevice(), gpu, p.camera, p.settings, tuning);
    double sum = 0;
    for (const PixelStatistics& pixel : render(backend, p.settings, {}).pixels)
        sum += pixel.mean.y;
    return sum / double(p.settings.area.width * p.settings.area.height);
}

/// Same random numbers, so the mean is the same but for samples that went another way. At a
/// millionth of the size a ray that starts 1e-4 off a surface starts outside the box.
TEST_F(DeviceTest, PlainPathKernelsMakeTheSamePictureOfScenesThatSuitThem) {
    LibraryPicture picture = libraryPicture("cornell_boxes", 32, 32, 4);
    const double robust = meanOf(picture, {});
    for (const PlainKernel& plain : plainPathKernels())
        EXPECT_NEAR(meanOf(picture, plain.code(texelFetch())) / robust, 1, 0.01) << plain.name;
    for (glm::vec3& p : picture.scene.positions)
        p *= 1e-6f;
    picture.camera.position *= 1e-6;
    picture.camera.nearDistance *= 1e-6;
    EXPECT_NEAR(meanOf(picture, {}) / robust, 1, 0.01);
    for (const PlainKernel& plain : plainPathKernels())
        if (plain.name != "no terminator") {
            EXPECT_LT(meanOf(picture, plain.code(texelFetch())), 0.9 * robust) << plain.name;
        }
}

} // namespace
} // namespace stromboli::bench
