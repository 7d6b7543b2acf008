#include "tests/support/device_fixture.hpp"

#include "host/process/process.hpp"
#include "host/vulkan/device.hpp"

#include <cstdio>
#include <memory>
#include <optional>

namespace stromboli::test {
namespace {

struct SharedDevice {
    std::unique_ptr<vulkan::Instance> instance =
        std::make_unique<vulkan::Instance>(true, [](Severity, const std::string& text) {
            std::fprintf(stderr, "%s\n", text.c_str());
        });
    std::unique_ptr<vulkan::Device> device;
    std::unique_ptr<vulkan::Queue> queue;

    SharedDevice() {
        const auto devices = vulkan::listDevices(*instance);
        const vulkan::DeviceChoice choice = vulkan::chooseDevice(devices, "");
        device = std::make_unique<vulkan::Device>(*instance, devices[choice.index]);
        queue = std::make_unique<vulkan::Queue>(*device);
    }
};

std::optional<SharedDevice> shared;

SharedDevice& open() {
    if (!shared) shared.emplace();
    return *shared;
}

/// Makes ready for the device as the program does, and closes it while the validation layer is
/// still heard.
class DeviceEnvironment : public ::testing::Environment {
  public:
    void SetUp() override { process::useWideVectors(); }
    void TearDown() override {
        if (!shared) return;
        const uint32_t before = shared->instance->validationMessages();
        shared->queue.reset();
        shared->device.reset();
        EXPECT_EQ(shared->instance->validationMessages(), before)
            << "the validation layer complained when the device was closed (see the log)";
        shared.reset();
    }
};

[[maybe_unused]] ::testing::Environment* const registered =
    ::testing::AddGlobalTestEnvironment(new DeviceEnvironment);

} // namespace

const vulkan::Device& testDevice() {
    return *open().device;
}

vulkan::Queue& testQueue() {
    return *open().queue;
}

uint32_t validationMessages() {
    return open().instance->validationMessages();
}

void DeviceTest::SetUp() {
    messagesBefore_ = validationMessages(); // throws, and so fails the test, without a device
}

void DeviceTest::TearDown() {
    if (!shared) return;
    EXPECT_EQ(validationMessages(), messagesBefore_)
        << "the validation layer complained during this test (see the log)";
}

} // namespace stromboli::test
