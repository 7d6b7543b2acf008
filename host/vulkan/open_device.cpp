#include "host/vulkan/open_device.hpp"

#include "host/core/error.hpp"

#include <fmt/format.h>

namespace stromboli::vulkan {

OpenDevice openDevice(const std::string& wanted) {
    OpenDevice open;
    open.instance = std::make_unique<Instance>(validationRequested());
    const std::vector<DeviceDescription> devices = listDevices(*open.instance);
    open.choice = chooseDevice(devices, wanted);
    std::optional<BlobCache> cache;
    if (const auto folder = userCacheFolder()) cache.emplace(*folder);
    open.device =
        std::make_unique<Device>(*open.instance, devices[open.choice.index], std::move(cache));
    return open;
}

void requireNoValidationMessages(const OpenDevice& open) {
    if (const uint32_t count = open.instance->validationMessages())
        throw DeviceError(fmt::format("the Vulkan validation layer reported {} messages", count));
}

} // namespace stromboli::vulkan
