// Memory of buffers on the device: what is counted is what the driver asks for.
#include "host/vulkan/buffer.hpp"
#include "host/vulkan/device.hpp"
#include "tests/support/device_fixture.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstring>
#include <fstream>
#include <iterator>
#include <string>

namespace stromboli::test {
namespace {

using vulkan::Buffer;
using vulkan::BufferUse;

class DeviceMemory : public DeviceTest {
  protected:
    static VkMemoryRequirements needs(const Buffer& buffer) {
        VkMemoryRequirements needs;
        testDevice().vk().vkGetBufferMemoryRequirements(testDevice().handle(), buffer.handle(),
                                                        &needs);
        return needs;
    }
};

TEST_F(DeviceMemory, IsCountedFromTheBirthOfABufferToItsEnd) {
    const uint64_t before = testDevice().allocatedBytes();
    {
        std::vector<Buffer> buffers;
        uint64_t asked = 0, needed = 0, rounding = 0;
        for (uint64_t bytes : {0, 1, 16, 17, 1000, 4096, 1'000'003})
            for (BufferUse use : {BufferUse::Storage, BufferUse::Texel, BufferUse::Uniform}) {
                // A texel buffer has whole rows, a uniform buffer is small.
                if (use == BufferUse::Texel) bytes = bytes / 16 * 16;
                if (use == BufferUse::Uniform) bytes %= 4096;
                const Buffer& b = buffers.emplace_back(testDevice(), "buffer", bytes, use);
                asked += b.bytes();
                needed += needs(b).size;
                rounding += needs(b).alignment;
            }
        EXPECT_EQ(testDevice().allocatedBytes() - before, needed);
        // The driver rounds each buffer up to its alignment, and adds no more than that.
        EXPECT_GE(needed, asked);
        EXPECT_LE(needed, asked + rounding);
        std::vector<Buffer> moved = std::move(buffers);
        EXPECT_EQ(testDevice().allocatedBytes() - before, needed);
        moved.pop_back();
        EXPECT_LT(testDevice().allocatedBytes() - before, needed);
    }
    EXPECT_EQ(testDevice().allocatedBytes(), before);
}

/// Bytes in huge pages, of all of this process's memory.
uint64_t inHugePages() {
    std::ifstream file("/proc/self/smaps_rollup");
    std::string line;
    while (std::getline(file, line))
        if (line.starts_with("AnonHugePages:")) return std::stoull(line.substr(14)) << 10; // kB
    return 0;
}

TEST_F(DeviceMemory, LargeBuffersOfTheCpuLieInHugePages) {
    if (!testDevice().description().isCpu()) GTEST_SKIP() << "a GPU's pages are the driver's";
    std::ifstream file("/sys/kernel/mm/transparent_hugepage/enabled");
    const std::string enabled{std::istreambuf_iterator<char>(file), {}};
    if (enabled.find("[madvise]") == std::string::npos)
        GTEST_SKIP() << "the system gives huge pages to all memory, or to none";
    const uint64_t before = inHugePages();
    constexpr uint64_t bytes = uint64_t(64) << 20;
    Buffer buffer(testDevice(), "buffer", bytes, BufferUse::Texel);
    buffer.upload(testQueue(), std::vector<std::byte>(bytes, std::byte(7)));
    // The system gives what it has; without the request it gives none.
    EXPECT_GE(inHugePages() - before, bytes / 2);
}

TEST_F(DeviceMemory, CopiesLeaveNothingBehind) {
    Buffer buffer(testDevice(), "buffer", 1000, BufferUse::Storage);
    const uint64_t before = testDevice().allocatedBytes();
    std::vector<std::byte> bytes(1000, std::byte(7));
    buffer.upload(testQueue(), bytes);
    buffer.download(testQueue(), bytes);
    EXPECT_EQ(testDevice().allocatedBytes(), before);
}

/// More than a staging buffer holds, so that it goes in pieces.
void expectLargeCopiesArrive(const vulkan::Device& device, vulkan::Queue& queue) {
    const uint64_t count = (uint64_t(64) << 20) / 4 + 1001;
    std::vector<uint32_t> sent(count), received(count);
    for (uint64_t i = 0; i < count; ++i)
        sent[i] = uint32_t(i * 2654435761u);
    Buffer buffer(device, "buffer", 4 * count + 4, BufferUse::Storage);
    buffer.upload(queue, std::as_bytes(std::span(sent)), 4);
    buffer.download(queue, std::as_writable_bytes(std::span(received)), 4);
    EXPECT_TRUE(sent == received);
    EXPECT_GE(device.allocatedBytes(), buffer.bytes());
    EXPECT_LT(device.allocatedBytes(), buffer.bytes() + (1 << 20)) << "staging left behind";
}

TEST_F(DeviceMemory, LargeCopiesArriveWhole) {
    expectLargeCopiesArrive(testDevice(), testQueue());
}

/// Counts on a device that claims to have memory of its own, as a graphics card has.
TEST_F(DeviceMemory, LargeCopiesArriveWholeInMemoryOfTheDevicesOwn) {
    const vulkan::Instance instance(true);
    std::vector<vulkan::DeviceDescription> devices = vulkan::listDevices(instance);
    vulkan::DeviceDescription& d = devices[vulkan::chooseDevice(devices, "").index];
    d.properties.deviceType = VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU;
    {
        const vulkan::Device device(instance, d);
        ASSERT_FALSE(device.description().sharesHostMemory());
        vulkan::Queue queue(device);
        expectLargeCopiesArrive(device, queue);
        EXPECT_EQ(device.allocatedBytes(), 0u);
    }
    EXPECT_EQ(instance.validationMessages(), 0u);
}

/// What the device itself makes of a buffer with these contents.
std::vector<uint32_t> readBack(const vulkan::Device& device, const Buffer& buffer) {
    vulkan::Queue queue(device);
    std::vector<uint32_t> words(buffer.bytes() / 4);
    buffer.download(queue, std::as_writable_bytes(std::span(words)));
    return words;
}

TEST_F(DeviceMemory, ACpuReadsPagesOfTheHostWhereTheyLie) {
    for (const size_t count : {3u, 1024u, 1025u, 300'001u})
        for (const BufferUse use : {BufferUse::Storage, BufferUse::Texel}) {
            if (use == BufferUse::Texel && count % 4 != 0) continue; // rows of four
            PageVector<uint32_t> sent(count);
            for (size_t i = 0; i < count; ++i)
                sent[i] = uint32_t(i * 2654435761u);
            const uint64_t before = testDevice().bytesUploaded();
            const Buffer buffer(testDevice(), "buffer", sent, use);
            const bool reads = testDevice().description().readsHostPages && count >= 1024;
            EXPECT_EQ(buffer.readsHost(), reads) << count;
            EXPECT_EQ(testDevice().bytesUploaded() - before, reads ? 0 : 4 * count) << count;
            const std::vector<uint32_t> received = readBack(testDevice(), buffer);
            EXPECT_TRUE(std::ranges::equal(std::span(received).first(count), sent)) << count;
        }
}

TEST_F(DeviceMemory, WhatCannotReadTheHostGetsACopy) {
    const vulkan::Instance instance(true);
    std::vector<vulkan::DeviceDescription> devices = vulkan::listDevices(instance);
    vulkan::DeviceDescription& d = devices[vulkan::chooseDevice(devices, "").index];
    d.readsHostPages = false;
    const vulkan::Device device(instance, d);
    PageVector<uint32_t> sent(5000, 7u);
    const Buffer buffer(device, "buffer", sent, BufferUse::Storage);
    sent.assign(5000, 8u);
    EXPECT_FALSE(buffer.readsHost());
    EXPECT_THAT(readBack(device, buffer), testing::Each(7u));
}

TEST_F(DeviceMemory, LimitsAreTheDevices) {
    const vulkan::DeviceDescription& d = testDevice().description();
    EXPECT_GE(d.largestAllocation, uint64_t(1) << 30); // the least that Vulkan allows
    EXPECT_GE(d.memory, uint64_t(1) << 28);
    EXPECT_GE(bindingLimit(d, BufferUse::Storage).bytes, uint64_t(1) << 27);
    EXPECT_GE(bindingLimit(d, BufferUse::Texel).bytes, uint64_t(16) << 16);
}

} // namespace
} // namespace stromboli::test
