#pragma once

#include <volk.h>

#include <string_view>

namespace stromboli::vulkan {

/// Throws DeviceError, naming the operation and the VkResult, unless result is VK_SUCCESS.
void check(VkResult result, std::string_view operation);

} // namespace stromboli::vulkan
