// Every limit a buffer can be over, on devices that exist only here.
#include "host/core/error.hpp"
#include "host/vulkan/buffer.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <functional>

namespace stromboli::vulkan {
namespace {

using testing::AllOf;
using testing::HasSubstr;

/// No limit but those a test sets.
DeviceDescription roomyDevice() {
    DeviceDescription d;
    std::snprintf(d.properties.deviceName, sizeof d.properties.deviceName, "Roomy");
    d.properties.limits.maxStorageBufferRange = ~0u;
    d.properties.limits.maxTexelBufferElements = ~0u;
    d.properties.limits.maxUniformBufferRange = ~0u;
    d.largestAllocation = ~uint64_t(0);
    d.memory = ~uint64_t(0);
    return d;
}

std::string messageOf(const std::function<void()>& action) {
    try {
        action();
    } catch (const DeviceError& error) {
        return error.what();
    }
    return "no error";
}

/// A buffer of `most` bytes fits, one byte more is refused, naming buffer, sizes and limit.
void expectLimit(const DeviceDescription& device, BufferUse use, uint64_t most,
                 const std::string& limit) {
    EXPECT_EQ(messageOf([&] { requireFits(device, {"lava", most, use}); }), "no error");
    EXPECT_THAT(messageOf([&] {
                    requireFits(device, {"lava", most + 1, use});
                }),
                AllOf(HasSubstr("lava"), HasSubstr("Roomy"), HasSubstr(std::to_string(most + 1)),
                      HasSubstr(std::to_string(most)), HasSubstr(limit)));
}

TEST(BufferLimits, StorageBuffersAreBoundByTheirRange) {
    DeviceDescription d = roomyDevice();
    d.properties.limits.maxStorageBufferRange = 1u << 27;
    expectLimit(d, BufferUse::Storage, 1u << 27, "maxStorageBufferRange");
}

/// What a shader may have of each kind, and all together.
DeviceDescription deviceWithCounts(uint32_t storage, uint32_t images, uint32_t uniforms,
                                   uint32_t all) {
    DeviceDescription d = roomyDevice();
    d.properties.limits.maxPerStageDescriptorStorageBuffers = storage;
    d.properties.limits.maxPerStageDescriptorStorageImages = images;
    d.properties.limits.maxPerStageDescriptorUniformBuffers = uniforms;
    d.properties.limits.maxPerStageResources = all;
    return d;
}

TEST(BufferLimits, AShaderHasNoMoreBuffersOfAKindThanTheDeviceAllows) {
    const std::vector<BufferUse> uses = {BufferUse::Storage, BufferUse::Storage,
                                         BufferUse::Storage, BufferUse::Texel,
                                         BufferUse::Texel,   BufferUse::Uniform};
    const auto messageOn = [&](const DeviceDescription& device) {
        const std::string message = messageOf([&] { requireBindable(device, uses); });
        EXPECT_EQ(areBindable(device, uses), message == "no error") << message;
        return message;
    };
    EXPECT_EQ(messageOn(deviceWithCounts(3, 2, 1, 6)), "no error");
    EXPECT_THAT(messageOn(deviceWithCounts(2, 2, 1, 6)),
                AllOf(HasSubstr("needs 3 storage buffers"), HasSubstr("Roomy"), HasSubstr(" 2 "),
                      HasSubstr("maxPerStageDescriptorStorageBuffers")));
    EXPECT_THAT(messageOn(deviceWithCounts(3, 1, 1, 6)),
                AllOf(HasSubstr("needs 2 storage texel buffers"),
                      HasSubstr("maxPerStageDescriptorStorageImages")));
    EXPECT_THAT(messageOn(deviceWithCounts(3, 2, 0, 6)),
                AllOf(HasSubstr("needs 1 uniform buffers"),
                      HasSubstr("maxPerStageDescriptorUniformBuffers")));
    EXPECT_THAT(messageOn(deviceWithCounts(3, 2, 1, 5)),
                AllOf(HasSubstr("needs 6 buffers"), HasSubstr("maxPerStageResources")));
}

TEST(BufferLimits, TexelBuffersAreMeasuredInRows) {
    DeviceDescription d = roomyDevice();
    d.properties.limits.maxTexelBufferElements = 1u << 27;
    expectLimit(d, BufferUse::Texel, uint64_t(16) << 27, "maxTexelBufferElements");
    d.properties.limits.maxTexelBufferElements = ~0u; // more than the kernel can number
    expectLimit(d, BufferUse::Texel, uint64_t(16) << 27, "27 bits");
}

TEST(BufferLimits, UniformBuffersAreBoundByTheirRange) {
    DeviceDescription d = roomyDevice();
    d.properties.limits.maxUniformBufferRange = 1u << 16;
    expectLimit(d, BufferUse::Uniform, 1u << 16, "maxUniformBufferRange");
}

TEST(BufferLimits, AllAreBoundByOneAllocationAndByTheMemory) {
    for (BufferUse use : {BufferUse::Storage, BufferUse::Texel, BufferUse::Uniform}) {
        DeviceDescription d = roomyDevice();
        d.largestAllocation = 1'000'000;
        expectLimit(d, use, 1'000'000, "maxMemoryAllocationSize");
        d = roomyDevice();
        d.memory = 1'000'000;
        expectLimit(d, use, 1'000'000, "1000000 bytes of memory");
    }
}

/// A buffer that the user can make smaller says how, alone and as the largest of many.
TEST(BufferLimits, MessagesNameTheRemedy) {
    DeviceDescription d = roomyDevice();
    d.memory = 1000;
    const BufferPlan textures{"texture buffer", 900, BufferUse::Storage, "--max-texture N helps"};
    BufferPlan large = textures;
    large.bytes = 1001;
    EXPECT_THAT(messageOf([&] { requireFits(d, large); }), HasSubstr("--max-texture N helps"));
    const std::vector<BufferPlan> both{{"lava", 200, BufferUse::Storage, ""}, textures};
    EXPECT_THAT(messageOf([&] { requireTogetherFit(d, both); }),
                HasSubstr("--max-texture N helps"));
}

TEST(BufferLimits, BuffersTogetherAreBoundByTheMemory) {
    DeviceDescription d = roomyDevice();
    d.memory = 1000;
    std::vector<BufferPlan> buffers = {{"lava", 600, BufferUse::Texel},
                                       {"ash", 400, BufferUse::Storage}};
    EXPECT_EQ(messageOf([&] { requireTogetherFit(d, buffers); }), "no error");
    buffers[1].bytes = 401;
    EXPECT_THAT(messageOf([&] { requireTogetherFit(d, buffers); }),
                AllOf(HasSubstr("1001"), HasSubstr("1000 bytes of memory"), HasSubstr("lava 600"),
                      HasSubstr("ash 401")));
}

} // namespace
} // namespace stromboli::vulkan
