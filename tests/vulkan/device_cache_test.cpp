// The pipeline cache on a real device: wherever it comes from, results are the same.
#include "host/vulkan/compute_pipeline.hpp"
#include "host/vulkan/device.hpp"
#include "tests/film/temporary_folder.hpp"

#include "embedded/squares_shader.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <cstring>

namespace stromboli::vulkan {
namespace {

namespace fs = std::filesystem;

/// Opens a device as the program does and computes 7 times the squares of 0 to 63.
std::vector<uint32_t> computeSquares() {
    const OpenDevice open = openDevice("");
    std::vector<uint32_t> numbers(64);
    for (uint32_t i = 0; i < 64; ++i)
        numbers[i] = i;
    {
        Queue queue(*open.device);
        Buffer buffer(*open.device, "numbers", 4 * numbers.size(), BufferUse::Storage);
        buffer.upload(queue, std::as_bytes(std::span(numbers)));
        const Binding binding{0, BufferUse::Storage};
        const uint32_t factor = 7;
        const ComputePipeline pipeline(*open.device, squares_shader, {&binding, 1}, {&factor, 1},
                                       0);
        const Buffer* const buffers[] = {&buffer};
        const DescriptorSet set(*open.device, pipeline, buffers);
        queue.run("compute squares", [&](VkCommandBuffer commands) {
            recordDispatch(*open.device, commands, pipeline, set, {}, 1);
        });
        buffer.download(queue, std::as_writable_bytes(std::span(numbers)));
    }
    requireNoValidationMessages(open);
    return numbers;
}

class DeviceCache : public testing::Test {
  protected:
    DeviceCache() {
        setenv("STROMBOLI_VALIDATION", "1", 1);
        setenv("STROMBOLI_CACHE_DIR", folder_.path().c_str(), 1);
        for (uint32_t i = 0; i < 64; ++i)
            expected_.push_back(7 * i * i);
    }
    ~DeviceCache() override { setenv("STROMBOLI_CACHE_DIR", "", 1); }

    TemporaryFolder folder_;
    std::vector<uint32_t> expected_;
};

TEST_F(DeviceCache, ColdAndWarmComputeTheSame) {
    EXPECT_EQ(computeSquares(), expected_);
    EXPECT_LE(folder_.size(), 1u); // none, where the driver gives nothing out
    EXPECT_EQ(computeSquares(), expected_);
    EXPECT_LE(folder_.size(), 1u);
}

/// A file that is whole, under this device's name, with pipelines of another driver.
TEST_F(DeviceCache, ForeignPipelinesAreReplaced) {
    const VkPhysicalDeviceProperties properties = openDevice("").device->description().properties;
    VkPipelineCacheHeaderVersionOne header{sizeof header,
                                           VK_PIPELINE_CACHE_HEADER_VERSION_ONE,
                                           properties.vendorID,
                                           properties.deviceID,
                                           {}};
    header.pipelineCacheUUID[0] = uint8_t(properties.pipelineCacheUUID[0] ^ 1);
    std::vector<std::byte> foreign(10'000, std::byte(0xCD));
    std::memcpy(foreign.data(), &header, sizeof header);
    BlobCache(folder_.path()).keep(pipelineCacheName(properties), foreign);
    EXPECT_EQ(computeSquares(), expected_);
    EXPECT_EQ(computeSquares(), expected_);
}

TEST_F(DeviceCache, DamagedFileComputesTheSame) {
    EXPECT_EQ(computeSquares(), expected_);
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_.path()))
        fs::resize_file(entry, fs::file_size(entry) / 2);
    EXPECT_EQ(computeSquares(), expected_);
}

TEST_F(DeviceCache, SwitchedOffComputesTheSame) {
    setenv("STROMBOLI_CACHE_DIR", "", 1);
    EXPECT_EQ(computeSquares(), expected_);
    EXPECT_EQ(folder_.size(), 0u);
}

} // namespace
} // namespace stromboli::vulkan
