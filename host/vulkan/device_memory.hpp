#pragma once

#include "host/vulkan/device.hpp"
#include "host/vulkan/handle.hpp"

#include <string>

namespace stromboli::vulkan {

/// Where memory should lie.
enum class MemoryPlace {
    Device, ///< fast for the device
    Host,   ///< mapped, coherent
};

/// Memory of a device with one buffer bound to it, counted in Device::allocatedBytes.
class DeviceMemory {
  public:
    DeviceMemory() = default;
    /// `name` of the buffer is for error messages. Throws DeviceError.
    DeviceMemory(const Device& device, VkBuffer buffer, MemoryPlace place, const std::string& name);
    ~DeviceMemory();
    DeviceMemory(DeviceMemory&& other) noexcept { *this = std::move(other); }
    DeviceMemory& operator=(DeviceMemory&& other) noexcept;

    /// Null unless in MemoryPlace::Host.
    std::byte* mapped() const { return mapped_; }
    /// What the driver asks for a buffer: its size rounded up to the driver's alignment.
    uint64_t bytes() const { return bytes_; }

  private:
    const Device* device_ = nullptr;
    Handle<VkDeviceMemory> memory_;
    uint64_t bytes_ = 0;
    std::byte* mapped_ = nullptr;
};

} // namespace stromboli::vulkan
