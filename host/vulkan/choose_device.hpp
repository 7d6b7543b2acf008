#pragma once

#include "host/vulkan/device.hpp"

#include <string>
#include <vector>

namespace stromboli::vulkan {

struct DeviceChoice {
    size_t index = 0;
    std::string reason;
};

/// Picks by `wanted`: empty (the best usable one: discrete, integrated, virtual, CPU, other), a
/// number in the list, "cpu", a UUID or part of a name (case-insensitive, must be unique).
/// Throws DeviceError if nothing fits or the device lacks something, saying what.
DeviceChoice chooseDevice(const std::vector<DeviceDescription>& devices, const std::string& wanted);

/// One or several: "all" (every usable one; those that are the host's own processor only where
/// there is no other), or what chooseDevice understands, with commas between (a name with a comma
/// in it is taken for a name). Throws DeviceError as chooseDevice does.
std::vector<DeviceChoice> chooseDevices(const std::vector<DeviceDescription>& devices,
                                        const std::string& wanted);

} // namespace stromboli::vulkan
