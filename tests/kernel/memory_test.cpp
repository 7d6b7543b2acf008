// Memory on the device: known, and refused by name, before anything is allocated.
#include "host/bvh/wide_layout.hpp"
#include "host/core/error.hpp"
#include "host/kernel/kernel_buffers.hpp"
#include "shaders/shared/render_types.h"
#include "source_dir.h"
#include "tests/render/device_render.hpp"
#include "tests/support/device_fixture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace stromboli {
namespace {

using namespace test;
using testing::AllOf;
using testing::HasSubstr;

class Memory : public DeviceTest {
  protected:
    static RenderSettings pictureOf(uint32_t width, uint32_t height) {
        RenderSettings s;
        s.area.width = width, s.area.height = height, s.budget.mostSamplesPerPixel = 1;
        return s;
    }

    /// What a backend allocates is what is planned, but for the driver's rounding: its alignment
    /// for each buffer.
    void expectPlanned(const RenderSettings& settings, const KernelTuning& tuning,
                       uint64_t segments) {
        const vulkan::Device& device = testDevice();
        uint64_t planned = 0, rounding = 0;
        const DeviceTuning resolved = resolve(tuning, device);
        for (const vulkan::BufferPlan& plan :
             planBuffers(scene_, settings.area, settings.estimator, resolved)) {
            planned += plan.bytes;
            const uint64_t count = plan.name == "film" ? segments : 1;
            rounding += count * alignmentOf(plan.use);
        }
        const uint64_t before = device.allocatedBytes();
        const VulkanBackend backend(
            device, scene_,
            makeCamera(loaded_, CameraChoice::Automatic, settings.area.width, settings.area.height),
            settings, tuning);
        const uint64_t allocated = device.allocatedBytes() - before;
        EXPECT_GE(allocated, planned);
        EXPECT_LE(allocated, planned + rounding);
    }

    static uint64_t alignmentOf(vulkan::BufferUse use) {
        const vulkan::Buffer buffer(testDevice(), "probe", 16, use);
        VkMemoryRequirements needs;
        testDevice().vk().vkGetBufferMemoryRequirements(testDevice().handle(), buffer.handle(),
                                                        &needs);
        return std::max<uint64_t>(needs.alignment, needs.size);
    }

    Scene loaded_ =
        loadScene(std::filesystem::path(STROMBOLI_SOURCE_DIR) / "scene/library/cornell_mesh.dae");
    GpuScene scene_ = packScene(loaded_, buildWideBvh(loaded_));
};

TEST_F(Memory, WhatIsPlannedIsAllocated) {
    expectPlanned(pictureOf(61, 37), {}, 1);
    expectPlanned(pictureOf(61, 37), {.texelFetch = false}, 1);
    expectPlanned(pictureOf(320, 240), {.lanes = 1000, .itemsPerDispatch = 500}, 1);
    RenderSettings branches = pictureOf(320, 240);
    branches.estimator.branches = 4;
    expectPlanned(branches, {}, 1);
    RenderSettings filtered = pictureOf(61, 37);
    filtered.estimator.filter = PixelFilter::Mitchell;
    expectPlanned(filtered, {}, 1);
    RenderSettings crop = pictureOf(4000, 3000);
    crop.area.crop = {10, 20, 30, 40};
    expectPlanned(crop, {}, 1);
}

TEST_F(Memory, FilmOfSeveralSegmentsIsPlannedToo) {
    const KernelTuning tuning{.texelFetch = false};
    const uint64_t perSegment =
        pixelsPerSegment(testDevice().description(), resolve(tuning, testDevice()));
    if (perSegment > 1u << 22) GTEST_SKIP() << "a segment holds a larger picture than is tried";
    expectPlanned(pictureOf(2048, uint32_t(perSegment / 2048) + 1), tuning, 2);
}

/// A device that exists only here: room for everything but what a test takes away.
vulkan::DeviceDescription roomyDevice() {
    vulkan::DeviceDescription d;
    d.properties.limits.maxStorageBufferRange = ~0u;
    d.properties.limits.maxTexelBufferElements = ~0u;
    d.properties.limits.maxUniformBufferRange = 1u << 16;
    d.largestAllocation = ~uint64_t(0);
    d.memory = ~uint64_t(0);
    return d;
}

std::string messageOf(const vulkan::DeviceDescription& device, const GpuScene& scene,
                      const RenderSettings& settings, const DeviceTuning& tuning) {
    try {
        checkMemory(device, scene, settings.area, settings.estimator, tuning);
    } catch (const DeviceError& error) {
        return error.what();
    }
    return "no error";
}

TEST_F(Memory, WhatDoesNotFitIsNamed) {
    const RenderSettings small = pictureOf(16, 16);
    const DeviceTuning texel{.texelFetch = true}, storage{.texelFetch = false};
    const uint64_t records = scene_.bvh.records.size() * sizeof(Record);
    vulkan::DeviceDescription d = roomyDevice();
    EXPECT_EQ(messageOf(d, scene_, small, texel), "no error");
    EXPECT_EQ(messageOf(d, scene_, small, storage), "no error");

    d.properties.limits.maxTexelBufferElements = uint32_t(records / 16 - 1);
    EXPECT_THAT(messageOf(d, scene_, small, texel),
                AllOf(HasSubstr("the BVH buffer needs " + std::to_string(records)),
                      HasSubstr("maxTexelBufferElements")));
    EXPECT_EQ(messageOf(d, scene_, small, storage), "no error");

    d = roomyDevice();
    d.properties.limits.maxStorageBufferRange = uint32_t(records - 1);
    EXPECT_THAT(messageOf(d, scene_, small, storage),
                AllOf(HasSubstr("the BVH buffer needs " + std::to_string(records)),
                      HasSubstr("maxStorageBufferRange")));

    d = roomyDevice();
    d.largestAllocation = records - 1;
    EXPECT_THAT(messageOf(d, scene_, small, texel),
                AllOf(HasSubstr("the BVH buffer needs"), HasSubstr("maxMemoryAllocationSize")));

    d = roomyDevice();
    d.memory = records + 1;
    EXPECT_THAT(messageOf(d, scene_, small, texel),
                AllOf(HasSubstr("together"), HasSubstr("BVH buffer " + std::to_string(records)),
                      HasSubstr("film " + std::to_string(256 * sizeof(gpu::PixelState)))));
}

/// Textures that are packed for speed take four times the memory of those that are packed plainly.
TEST_F(Memory, TexturesThatHaveNoRoomArePackedPlainly) {
    Scene scene = loaded_;
    scene.images = {
        {.width = 64, .height = 64, .words = std::vector<uint32_t>(64 * 64, 0xFF804020)}};
    scene.textures.resize(1);
    for (Material& m : scene.materials)
        m.textures = {{.slot = TextureSlot::BaseColor}};
    const GpuScene fast = packScene(scene, buildWideBvh(scene)),
                   plain = packScene(scene, buildWideBvh(scene), {}, {}, 0);
    EXPECT_TRUE(fast.texelKinds & gpu::TEXEL_KIND_GATHERED);
    EXPECT_FALSE(fast.texelKinds & gpu::TEXEL_KIND_PLAIN);
    EXPECT_FALSE(plain.texelKinds & (gpu::TEXEL_KIND_GATHERED | gpu::TEXEL_KIND_BUNDLE));
    EXPECT_LT(plain.details.rows.size(), fast.details.rows.size() / 2);
    vulkan::DeviceDescription d = roomyDevice();
    EXPECT_TRUE(haveRoomForTextures(d, fast));
    const uint64_t bytes = fast.details.rows.size() * sizeof(Row);
    d.largestAllocation = bytes - 1;
    EXPECT_FALSE(haveRoomForTextures(d, fast));
    EXPECT_TRUE(haveRoomForTextures(d, plain));
    d = roomyDevice();
    d.properties.limits.maxTexelBufferElements = uint32_t(fast.details.rows.size() - 1);
    d.properties.limits.maxStorageBufferRange = uint32_t(bytes - 1);
    EXPECT_FALSE(haveRoomForTextures(d, fast));
    EXPECT_TRUE(haveRoomForTextures(d, plain));
    d = roomyDevice();
    d.memory = bytes;
    EXPECT_FALSE(haveRoomForTextures(d, fast)) << "the tree has no room beside them";
}

/// The film is no scene buffer: a large one is cut into segments, not refused.
TEST_F(Memory, FilmIsCutToWhatFits) {
    vulkan::DeviceDescription d = roomyDevice();
    const DeviceTuning texel{.texelFetch = true}, storage{.texelFetch = false};
    d.properties.limits.maxStorageBufferRange = 1u << 27;
    EXPECT_EQ(pixelsPerSegment(d, storage), (1u << 27) / sizeof(gpu::PixelState));
    d.properties.limits.maxTexelBufferElements = 1u << 16; // the least that Vulkan allows
    EXPECT_EQ(pixelsPerSegment(d, texel), (16u << 16) / sizeof(gpu::PixelState));
    d.largestAllocation = 1u << 19;
    EXPECT_EQ(pixelsPerSegment(d, texel), (1u << 19) / sizeof(gpu::PixelState));
    EXPECT_EQ(pixelsPerSegment(d, storage), (1u << 19) / sizeof(gpu::PixelState));
}

} // namespace
} // namespace stromboli
