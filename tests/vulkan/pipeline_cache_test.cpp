// What is kept of a driver's pipelines, with a driver that exists only here: lavapipe's cache is
// always empty.
#include "host/vulkan/pipeline_cache.hpp"
#include "tests/film/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstring>
#include <fstream>

namespace stromboli::vulkan {
namespace {

namespace fs = std::filesystem;
using Blob = std::vector<std::byte>;

VkPhysicalDeviceProperties someDevice() {
    VkPhysicalDeviceProperties p{};
    p.vendorID = 0x10DE;
    p.deviceID = 0x2335;
    p.driverVersion = 0x12345678;
    for (uint8_t i = 0; i < VK_UUID_SIZE; ++i)
        p.pipelineCacheUUID[i] = uint8_t(0xA0 + i);
    return p;
}

/// What the driver of such a device would give out: a header and its own bytes.
Blob dataOf(const VkPhysicalDeviceProperties& p, const std::string& pipelines) {
    VkPipelineCacheHeaderVersionOne header{
        sizeof header, VK_PIPELINE_CACHE_HEADER_VERSION_ONE, p.vendorID, p.deviceID, {}};
    std::memcpy(header.pipelineCacheUUID, p.pipelineCacheUUID, VK_UUID_SIZE);
    Blob data(sizeof header + pipelines.size());
    std::memcpy(data.data(), &header, sizeof header);
    std::memcpy(data.data() + sizeof header, pipelines.data(), pipelines.size());
    return data;
}

/// The driver: its one cache holds what it was given, or a bare header.
struct Driver {
    bool hasCache = true;      ///< can make one at all
    bool takesData = true;     ///< accepts data from earlier runs
    bool givesData = true;     ///< gives its data out
    std::optional<Blob> cache; ///< while there is one
    Blob given;                ///< what it was created from
};
Driver driver;

VKAPI_ATTR VkResult VKAPI_CALL create(VkDevice, const VkPipelineCacheCreateInfo* info,
                                      const VkAllocationCallbacks*, VkPipelineCache* cache) {
    if (!driver.hasCache || (info->initialDataSize > 0 && !driver.takesData))
        return VK_ERROR_OUT_OF_HOST_MEMORY;
    const auto* data = static_cast<const std::byte*>(info->pInitialData);
    driver.given.assign(data, data + info->initialDataSize);
    driver.cache = driver.given.empty() ? dataOf(someDevice(), "") : driver.given;
    *cache = reinterpret_cast<VkPipelineCache>(&driver);
    return VK_SUCCESS;
}

VKAPI_ATTR VkResult VKAPI_CALL getData(VkDevice, VkPipelineCache, size_t* size, void* data) {
    if (!driver.givesData) return VK_ERROR_OUT_OF_HOST_MEMORY;
    if (data) std::memcpy(data, driver.cache->data(), *size);
    *size = driver.cache->size();
    return VK_SUCCESS;
}

VKAPI_ATTR void VKAPI_CALL destroy(VkDevice, VkPipelineCache, const VkAllocationCallbacks*) {
    driver.cache.reset();
}

class Pipelines : public testing::Test {
  protected:
    Pipelines() {
        driver = {};
        vk_.vkCreatePipelineCache = create;
        vk_.vkGetPipelineCacheData = getData;
        vk_.vkDestroyPipelineCache = destroy;
    }
    ~Pipelines() override { EXPECT_FALSE(driver.cache) << "never destroyed"; }

    /// A run of the program in which the driver compiles `pipelines`; what it found is in
    /// driver.given.
    void run(const std::string& pipelines,
             const VkPhysicalDeviceProperties& device = someDevice()) {
        PipelineCache cache(VK_NULL_HANDLE, vk_, device, BlobCache(folder_.path()));
        EXPECT_EQ(cache.bytesFound(), driver.given.size());
        if (driver.cache) *driver.cache = dataOf(device, pipelines);
    }
    fs::path file() const { return fs::directory_iterator(folder_.path())->path(); }

    VolkDeviceTable vk_{};
    TemporaryFolder folder_;
};

TEST_F(Pipelines, AreFoundByTheNextRun) {
    run("lava");
    EXPECT_TRUE(driver.given.empty());
    run("lava and ash");
    EXPECT_EQ(driver.given, dataOf(someDevice(), "lava"));
    run("");
    EXPECT_EQ(driver.given, dataOf(someDevice(), "lava and ash"));
    EXPECT_EQ(folder_.size(), 1u);
}

TEST_F(Pipelines, AreWrittenOnlyIfTheyChanged) {
    run("lava");
    {
        PipelineCache cache(VK_NULL_HANDLE, vk_, someDevice(), BlobCache(folder_.path()));
        EXPECT_GT(cache.bytesFound(), 0u);
        fs::remove(file()); // or it could not be seen that nothing is written
    }
    EXPECT_EQ(folder_.size(), 0u);
}

TEST_F(Pipelines, BareHeaderIsNotKept) {
    run("");
    EXPECT_EQ(folder_.size(), 0u);
}

TEST_F(Pipelines, AreNotKeptWithoutAFolder) {
    PipelineCache cache(VK_NULL_HANDLE, vk_, someDevice(), std::nullopt);
    *driver.cache = dataOf(someDevice(), "lava");
    cache.save();
    EXPECT_NE(cache.handle(), VkPipelineCache(VK_NULL_HANDLE));
}

/// Another device, driver version or build of the driver has a file of its own...
TEST_F(Pipelines, OfOtherDevicesAndDriversAreKeptApart) {
    VkPhysicalDeviceProperties other[4] = {someDevice(), someDevice(), someDevice(), someDevice()};
    other[0].vendorID ^= 1;
    other[1].deviceID ^= 1;
    other[2].driverVersion ^= 1;
    other[3].pipelineCacheUUID[15] ^= 1;
    run("lava");
    for (const VkPhysicalDeviceProperties& device : other) {
        run("ash", device);
        EXPECT_TRUE(driver.given.empty());
    }
    EXPECT_EQ(folder_.size(), 5u);
    run("lava");
    EXPECT_EQ(driver.given, dataOf(someDevice(), "lava"));
}

/// ...and what comes to lie under its name all the same is not given to the driver.
TEST_F(Pipelines, OfOtherDevicesAreNeverGivenToTheDriver) {
    const BlobCache kept(folder_.path());
    const std::string name = pipelineCacheName(someDevice());
    VkPhysicalDeviceProperties other[3] = {someDevice(), someDevice(), someDevice()};
    other[0].vendorID ^= 1;
    other[1].deviceID ^= 1;
    other[2].pipelineCacheUUID[15] ^= 1;
    for (const VkPhysicalDeviceProperties& device : other) {
        kept.keep(name, dataOf(device, "ash"));
        run("lava");
        EXPECT_TRUE(driver.given.empty());
        EXPECT_EQ(kept.find(name), dataOf(someDevice(), "lava")) << "replaced";
    }
}

TEST_F(Pipelines, HeaderIsChecked) {
    const Blob good = dataOf(someDevice(), "lava");
    EXPECT_TRUE(isPipelineCacheOf(someDevice(), good));
    for (size_t length = 0; length < sizeof(VkPipelineCacheHeaderVersionOne); ++length)
        EXPECT_FALSE(isPipelineCacheOf(someDevice(), std::span(good).first(length))) << length;
    Blob bad = good;
    bad[4] = std::byte(2); // header version
    EXPECT_FALSE(isPipelineCacheOf(someDevice(), bad));
    bad = good;
    bad[0] = std::byte(good.size() + 1); // header length
    EXPECT_FALSE(isPipelineCacheOf(someDevice(), bad));
    bad[0] = std::byte(sizeof(VkPipelineCacheHeaderVersionOne) - 1);
    EXPECT_FALSE(isPipelineCacheOf(someDevice(), bad));
}

TEST_F(Pipelines, DamagedFileIsReplaced) {
    run("lava");
    fs::resize_file(file(), fs::file_size(file()) - 1);
    run("lava");
    EXPECT_TRUE(driver.given.empty());
    run("lava");
    EXPECT_EQ(driver.given, dataOf(someDevice(), "lava"));
}

TEST_F(Pipelines, DriverThatRefusesTheDataStartsAfresh) {
    run("lava");
    driver.takesData = false;
    run("ash");
    EXPECT_TRUE(driver.given.empty());
    driver.takesData = true;
    run("");
    EXPECT_EQ(driver.given, dataOf(someDevice(), "ash"));
}

TEST_F(Pipelines, DriverWithoutACacheIsNoError) {
    driver.hasCache = false;
    run("lava");
    PipelineCache cache(VK_NULL_HANDLE, vk_, someDevice(), BlobCache(folder_.path()));
    EXPECT_EQ(cache.handle(), VkPipelineCache(VK_NULL_HANDLE));
    EXPECT_EQ(folder_.size(), 0u);
}

TEST_F(Pipelines, DriverThatGivesNothingOutIsNoError) {
    driver.givesData = false;
    run("lava");
    EXPECT_EQ(folder_.size(), 0u);
}

} // namespace
} // namespace stromboli::vulkan
