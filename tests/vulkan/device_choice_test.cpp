// Which device is taken, on machines that tests do not have: descriptions made by hand.
#include "host/core/error.hpp"
#include "host/vulkan/device.hpp"

#include <gtest/gtest.h>

#include <cstring>

namespace stromboli::vulkan {
namespace {

DeviceDescription device(const char* name, VkPhysicalDeviceType type, const char* missing = "") {
    DeviceDescription d;
    std::strcpy(d.properties.deviceName, name);
    d.properties.deviceType = type;
    d.missing = missing;
    d.uuid = std::string("uuid of ") + name;
    return d;
}

const std::vector<DeviceDescription> kMachine = {
    device("llvmpipe", VK_PHYSICAL_DEVICE_TYPE_CPU),
    device("Virtual One", VK_PHYSICAL_DEVICE_TYPE_VIRTUAL_GPU),
    device("Laptop Graphics", VK_PHYSICAL_DEVICE_TYPE_INTEGRATED_GPU),
    device("Old Card", VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU, "Vulkan 1.1"),
    device("Big Card", VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU),
    device("Big Card Twin", VK_PHYSICAL_DEVICE_TYPE_DISCRETE_GPU),
};

size_t chosen(std::vector<DeviceDescription> devices, const std::string& wanted = "") {
    return chooseDevice(devices, wanted).index;
}

TEST(DeviceChoice, PrefersDiscreteThenIntegratedThenVirtualThenCpu) {
    std::vector<DeviceDescription> devices = kMachine;
    for (const char* expected : {"Big Card", "Laptop Graphics", "Virtual One", "llvmpipe"}) {
        EXPECT_EQ(devices[chosen(devices)].name(), expected);
        const auto type = devices[chosen(devices)].properties.deviceType;
        std::erase_if(devices, [&](const auto& d) { return d.properties.deviceType == type; });
    }
}

TEST(DeviceChoice, ByNumberNameUuidOrCpu) {
    EXPECT_EQ(chosen(kMachine, "2"), 2u);
    EXPECT_EQ(chosen(kMachine, "laptop"), 2u);
    EXPECT_EQ(chosen(kMachine, "TWIN"), 5u);
    EXPECT_EQ(chosen(kMachine, "cpu"), 0u);
    EXPECT_EQ(chosen(kMachine, "uuid of Big Card"), 4u);
}

std::vector<size_t> several(const std::string& wanted) {
    std::vector<size_t> indices;
    for (const DeviceChoice& choice : chooseDevices(kMachine, wanted))
        indices.push_back(choice.index);
    return indices;
}

TEST(DeviceChoice, OfSeveral) {
    using Indices = std::vector<size_t>;
    EXPECT_EQ(several("all"), (Indices{1, 2, 4, 5})); // one cannot be used, one is the processor
    EXPECT_EQ(several("ALL"), several("all"));
    const std::vector<DeviceDescription> processors = {
        device("llvmpipe", VK_PHYSICAL_DEVICE_TYPE_CPU),
        device("SwiftShader", VK_PHYSICAL_DEVICE_TYPE_CPU)};
    EXPECT_EQ(chooseDevices(processors, "all").size(), 2u);
    EXPECT_EQ(several("0, 2"), (Indices{0, 2}));
    EXPECT_EQ(several("twin,cpu,4"), (Indices{5, 0, 4}));
    EXPECT_EQ(several("4,4"), (Indices{4, 4}));
    EXPECT_EQ(several(""), Indices{4});
    EXPECT_THROW(several("0,"), DeviceError);
    EXPECT_THROW(several("0,,2"), DeviceError);
    EXPECT_THROW(several("0,voodoo"), DeviceError);
    for (const char* wanted : {"all", "0,0"})
        EXPECT_THROW(chosen(kMachine, wanted), DeviceError);
    // Names may have commas of their own.
    const std::vector<DeviceDescription> one = {
        device("llvmpipe (LLVM 15.0.6, 512 bits)", VK_PHYSICAL_DEVICE_TYPE_CPU)};
    EXPECT_EQ(chooseDevices(one, "LLVM 15.0.6, 512").size(), 1u);
}

TEST(DeviceChoice, SaysWhyItCannot) {
    EXPECT_THROW(chosen({}), DeviceError);
    EXPECT_THROW(chosen(kMachine, "6"), DeviceError);
    EXPECT_THROW(chosen(kMachine, "voodoo"), DeviceError);
    EXPECT_THROW(chosen(kMachine, "big card"), DeviceError); // two of them
    try {
        chosen(kMachine, "old");
        FAIL();
    } catch (const DeviceError& error) {
        EXPECT_NE(std::string(error.what()).find("Vulkan 1.1"), std::string::npos);
    }
}

} // namespace
} // namespace stromboli::vulkan
