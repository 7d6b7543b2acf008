#pragma once

#include <volk.h>

#include <string_view>

namespace stromboli::vulkan {

/// Throws DeviceError (DeviceLostError for a lost device), naming the operation and the VkResult,
/// unless result is VK_SUCCESS.
void check(VkResult result, std::string_view operation);

} // namespace stromboli::vulkan
