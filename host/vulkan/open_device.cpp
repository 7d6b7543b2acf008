#include "host/vulkan/open_device.hpp"

#include "host/core/error.hpp"

#include <fmt/format.h>

namespace stromboli::vulkan {
namespace {

OpenDevice opened(std::unique_ptr<Instance> instance, const std::vector<DeviceDescription>& devices,
                  DeviceChoice choice) {
    OpenDevice open;
    open.instance = std::move(instance);
    open.choice = std::move(choice);
    std::optional<BlobCache> cache;
    if (const auto folder = userCacheFolder()) cache.emplace(*folder);
    open.device =
        std::make_unique<Device>(*open.instance, devices[open.choice.index], std::move(cache));
    return open;
}

} // namespace

OpenDevice openDevice(const std::string& wanted) {
    auto instance = std::make_unique<Instance>(validationRequested());
    const std::vector<DeviceDescription> devices = listDevices(*instance);
    return opened(std::move(instance), devices, chooseDevice(devices, wanted));
}

std::vector<OpenDevice> openDevices(const std::string& wanted) {
    auto instance = std::make_unique<Instance>(validationRequested());
    const std::vector<DeviceChoice> choices = chooseDevices(listDevices(*instance), wanted);
    std::vector<OpenDevice> open;
    for (const DeviceChoice& choice : choices) {
        if (!instance) instance = std::make_unique<Instance>(validationRequested());
        const std::vector<DeviceDescription> devices = listDevices(*instance);
        open.push_back(opened(std::move(instance), devices, choice));
    }
    return open;
}

void requireNoValidationMessages(const OpenDevice& open) {
    if (const uint32_t count = open.instance->validationMessages())
        throw DeviceError(fmt::format("the Vulkan validation layer reported {} messages", count));
}

} // namespace stromboli::vulkan
