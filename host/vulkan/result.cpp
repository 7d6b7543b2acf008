#include "host/vulkan/result.hpp"

#include "host/core/error.hpp"

#include <fmt/format.h>

namespace stromboli::vulkan {
namespace {

std::string_view name(VkResult result) {
    switch (result) {
    case VK_ERROR_OUT_OF_HOST_MEMORY:
        return "out of host memory";
    case VK_ERROR_OUT_OF_DEVICE_MEMORY:
        return "out of device memory";
    case VK_ERROR_INITIALIZATION_FAILED:
        return "initialisation failed";
    case VK_ERROR_DEVICE_LOST:
        return "device lost: the driver reset the device; another program, a watchdog or a driver "
               "fault";
    case VK_ERROR_MEMORY_MAP_FAILED:
        return "memory map failed";
    case VK_ERROR_LAYER_NOT_PRESENT:
        return "layer not present";
    case VK_ERROR_EXTENSION_NOT_PRESENT:
        return "extension not present";
    case VK_ERROR_FEATURE_NOT_PRESENT:
        return "feature not present";
    case VK_ERROR_INCOMPATIBLE_DRIVER:
        return "incompatible driver";
    case VK_ERROR_TOO_MANY_OBJECTS:
        return "too many objects";
    case VK_TIMEOUT:
        return "timeout";
    default:
        return {};
    }
}

} // namespace

void check(VkResult result, std::string_view operation) {
    if (result == VK_SUCCESS) return;
    const std::string_view text = name(result);
    if (text.empty())
        throw DeviceError(fmt::format("Vulkan: cannot {}: VkResult {}", operation, int(result)));
    if (result == VK_ERROR_DEVICE_LOST)
        throw DeviceLostError(fmt::format("Vulkan: cannot {}: {}", operation, text));
    throw DeviceError(fmt::format("Vulkan: cannot {}: {}", operation, text));
}

} // namespace stromboli::vulkan
