// Whether the kernel reads its rows through texel buffers, on devices that exist only here.
#include "host/kernel/kernel_tuning.hpp"

#include <gtest/gtest.h>

namespace stromboli::test {
namespace {

/// Limits as those of lavapipe, which prefers texel buffers.
vulkan::DeviceDescription cpuDevice() {
    vulkan::DeviceDescription d;
    d.properties.deviceType = VK_PHYSICAL_DEVICE_TYPE_CPU;
    d.properties.limits.maxTexelBufferElements = 1u << 27;
    d.properties.limits.maxPerStageDescriptorStorageImages = 32;
    d.properties.limits.maxPerStageResources = 128;
    return d;
}

TEST(TexelChoice, FollowsTheKindOfDevice) {
    EXPECT_TRUE(prefersTexels(cpuDevice(), 1 << 20));
    vulkan::DeviceDescription gpu = cpuDevice();
    gpu.properties.deviceType = VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
    EXPECT_FALSE(prefersTexels(gpu, 1 << 20));
}

TEST(TexelChoice, FollowsTheSizeOfTexelBuffers) {
    vulkan::DeviceDescription d = cpuDevice();
    d.properties.limits.maxTexelBufferElements = 65536; // what Vulkan guarantees: 1 MiB of rows
    EXPECT_TRUE(prefersTexels(d, 1 << 20));
    EXPECT_FALSE(prefersTexels(d, (1 << 20) + 1));
}

TEST(TexelChoice, FollowsTheNumberOfTexelBuffers) {
    vulkan::DeviceDescription d = cpuDevice();
    d.properties.limits.maxPerStageDescriptorStorageImages = 4; // what Vulkan guarantees
    EXPECT_FALSE(prefersTexels(d, 1 << 20));
}

} // namespace
} // namespace stromboli::test
