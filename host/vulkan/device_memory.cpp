#include "host/vulkan/device_memory.hpp"

#include "host/core/error.hpp"
#include "host/vulkan/huge_pages.hpp"
#include "host/vulkan/result.hpp"

#include <fmt/format.h>

#include <utility>

namespace stromboli::vulkan {
namespace {

VkMemoryPropertyFlags flagsOf(MemoryPlace place) {
    return place == MemoryPlace::Device
               ? VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT
               : VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;
}

/// The first type that fits: the specification puts the best one first. The host's memory is
/// cached where it can be: from memory that is not, the host reads some bytes at a time, hundreds
/// of times slower.
uint32_t memoryType(const Device& device, uint32_t allowed, MemoryPlace place,
                    const std::string& name) {
    const VkPhysicalDeviceMemoryProperties& memory = device.memory();
    const VkMemoryPropertyFlags least = flagsOf(place);
    const VkMemoryPropertyFlags best =
        place == MemoryPlace::Host ? least | VK_MEMORY_PROPERTY_HOST_CACHED_BIT : least;
    for (const VkMemoryPropertyFlags wanted : {best, least})
        for (uint32_t i = 0; i < memory.memoryTypeCount; ++i)
            if ((allowed & (1u << i)) && (memory.memoryTypes[i].propertyFlags & wanted) == wanted)
                return i;
    throw DeviceError(
        fmt::format("no memory type of {} fits the {}", device.description().name(), name));
}

} // namespace

DeviceMemory::DeviceMemory(const Device& device, VkBuffer buffer, MemoryPlace place,
                           const std::string& name) {
    VkMemoryRequirements needs;
    device.vk().vkGetBufferMemoryRequirements(device.handle(), buffer, &needs);
    const VkMemoryAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                       .allocationSize = needs.size,
                                       .memoryTypeIndex =
                                           memoryType(device, needs.memoryTypeBits, place, name)};
    VkDeviceMemory memory = VK_NULL_HANDLE;
    check(device.vk().vkAllocateMemory(device.handle(), &info, nullptr, &memory),
          fmt::format("allocate {} bytes for the {}", needs.size, name));
    memory_ = {device.handle(), memory, device.vk().vkFreeMemory};
    check(device.vk().vkBindBufferMemory(device.handle(), buffer, memory, 0),
          fmt::format("bind the {}", name));
    if (place == MemoryPlace::Host) {
        void* mapped = nullptr;
        check(device.vk().vkMapMemory(device.handle(), memory, 0, VK_WHOLE_SIZE, 0, &mapped),
              fmt::format("map the {}", name));
        mapped_ = static_cast<std::byte*>(mapped);
        if (device.description().isCpu()) preferHugePages({mapped_, needs.size});
    }
    device_ = &device;
    bytes_ = needs.size;
    device.countAllocation(int64_t(bytes_));
}

DeviceMemory::~DeviceMemory() {
    if (device_) device_->countAllocation(-int64_t(bytes_));
}

DeviceMemory& DeviceMemory::operator=(DeviceMemory&& other) noexcept {
    std::swap(device_, other.device_);
    std::swap(memory_, other.memory_);
    std::swap(bytes_, other.bytes_);
    std::swap(mapped_, other.mapped_);
    return *this;
}

} // namespace stromboli::vulkan
