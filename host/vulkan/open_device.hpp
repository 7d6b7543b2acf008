#pragma once

#include "host/vulkan/choose_device.hpp"
#include "host/vulkan/device.hpp"

#include <memory>
#include <string>
#include <vector>

namespace stromboli::vulkan {

/// An instance and the device chosen from it, kept together in the right order of destruction.
struct OpenDevice {
    std::unique_ptr<Instance> instance;
    std::unique_ptr<Device> device;
    DeviceChoice choice;
};

/// Opens the device `wanted` names (chooseDevice), with the validation layer if the environment
/// asks for it, and with the pipelines that earlier runs kept in the user's cache folder. Throws
/// DeviceError.
OpenDevice openDevice(const std::string& wanted);

/// The devices that `wanted` names (chooseDevices), each with an instance of its own; a device that
/// is named twice is opened twice. Throws DeviceError.
std::vector<OpenDevice> openDevices(const std::string& wanted);

/// Throws DeviceError if the validation layer had anything to say.
void requireNoValidationMessages(const OpenDevice& open);

} // namespace stromboli::vulkan
