#include "host/vulkan/buffer.hpp"

#include "host/core/error.hpp"
#include "host/vulkan/result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace stromboli::vulkan {
namespace {

constexpr uint64_t kRowBytes = 16; // one RGBA32UI texel

/// Host-visible memory that lives for one copy.
class Staging {
  public:
    Staging(const Device& device, uint64_t bytes);

  private:
    Handle<VkDeviceMemory> memory_; // declared first: freed last

  public:
    Handle<VkBuffer> buffer;
    std::byte* mapped = nullptr;
};

constexpr VkMemoryPropertyFlags kHostVisible =
    VK_MEMORY_PROPERTY_HOST_VISIBLE_BIT | VK_MEMORY_PROPERTY_HOST_COHERENT_BIT;

Handle<VkDeviceMemory> allocateFor(const Device& device, VkBuffer buffer,
                                   VkMemoryPropertyFlags wanted, const std::string& name) {
    VkMemoryRequirements needs;
    device.vk().vkGetBufferMemoryRequirements(device.handle(), buffer, &needs);
    const VkPhysicalDeviceMemoryProperties& memory = device.memory();
    for (uint32_t i = 0; i < memory.memoryTypeCount; ++i) {
        if (!(needs.memoryTypeBits & (1u << i))) continue;
        if ((memory.memoryTypes[i].propertyFlags & wanted) != wanted) continue;
        const VkMemoryAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                           .allocationSize = needs.size,
                                           .memoryTypeIndex = i};
        VkDeviceMemory result = VK_NULL_HANDLE;
        check(device.vk().vkAllocateMemory(device.handle(), &info, nullptr, &result),
              fmt::format("allocate {} bytes for the {}", needs.size, name));
        Handle<VkDeviceMemory> owned(device.handle(), result, device.vk().vkFreeMemory);
        check(device.vk().vkBindBufferMemory(device.handle(), buffer, result, 0),
              fmt::format("bind the {}", name));
        return owned;
    }
    throw DeviceError(
        fmt::format("no memory type of {} fits the {}", device.description().name(), name));
}

Handle<VkBuffer> createBuffer(const Device& device, uint64_t bytes, VkBufferUsageFlags usage,
                              const std::string& name) {
    const VkBufferCreateInfo info = {
        .sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO, .size = bytes, .usage = usage};
    VkBuffer buffer = VK_NULL_HANDLE;
    check(device.vk().vkCreateBuffer(device.handle(), &info, nullptr, &buffer),
          fmt::format("create the {}", name));
    return {device.handle(), buffer, device.vk().vkDestroyBuffer};
}

std::byte* map(const Device& device, VkDeviceMemory memory, const std::string& name) {
    void* mapped = nullptr;
    check(device.vk().vkMapMemory(device.handle(), memory, 0, VK_WHOLE_SIZE, 0, &mapped),
          fmt::format("map the {}", name));
    return static_cast<std::byte*>(mapped);
}

Staging::Staging(const Device& device, uint64_t bytes)
    : buffer(createBuffer(device, bytes,
                          VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT,
                          "staging buffer")) {
    memory_ = allocateFor(device, buffer.get(), kHostVisible, "staging buffer");
    mapped = map(device, memory_.get(), "staging buffer");
}

VkBufferUsageFlags usageOf(BufferUse use) {
    const VkBufferUsageFlags copies =
        VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;
    switch (use) {
    case BufferUse::Texel:
        return copies | VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT;
    case BufferUse::Uniform:
        return copies | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT;
    default:
        return copies | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT;
    }
}

} // namespace

void Buffer::checkLimits(const Device& device, const std::string& name, uint64_t bytes,
                         BufferUse use) {
    const VkPhysicalDeviceLimits& limits = device.limits();
    uint64_t most = limits.maxStorageBufferRange;
    const char* limit = "maxStorageBufferRange";
    if (use == BufferUse::Texel)
        most = uint64_t(limits.maxTexelBufferElements) * kRowBytes,
        limit = "maxTexelBufferElements";
    if (use == BufferUse::Uniform)
        most = limits.maxUniformBufferRange, limit = "maxUniformBufferRange";
    if (bytes > most)
        throw DeviceError(fmt::format("the {} needs {} bytes, but {} allows {} ({})", name, bytes,
                                      device.description().name(), most, limit));
    if (bytes > device.description().memory)
        throw DeviceError(fmt::format("the {} needs {} bytes, but {} has {} bytes of memory", name,
                                      bytes, device.description().name(),
                                      device.description().memory));
}

Buffer::Buffer(const Device& device, std::string name, uint64_t bytes, BufferUse use)
    : device_(&device), name_(std::move(name)), bytes_(std::max(bytes, kRowBytes)), use_(use) {
    checkLimits(device, name_, bytes_, use);
    buffer_ = createBuffer(device, bytes_, usageOf(use), name_);
    const bool shared = device.description().sharesHostMemory();
    const VkMemoryPropertyFlags deviceLocal = VK_MEMORY_PROPERTY_DEVICE_LOCAL_BIT;
    memory_ = allocateFor(device, buffer_.get(), shared ? kHostVisible : deviceLocal, name_);
    if (shared) mapped_ = map(device, memory_.get(), name_);
    if (use == BufferUse::Texel) {
        const VkBufferViewCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO,
                                             .buffer = buffer_.get(),
                                             .format = VK_FORMAT_R32G32B32A32_UINT,
                                             .range = VK_WHOLE_SIZE};
        VkBufferView view = VK_NULL_HANDLE;
        check(device.vk().vkCreateBufferView(device.handle(), &info, nullptr, &view),
              fmt::format("create a view of the {}", name_));
        view_ = {device.handle(), view, device.vk().vkDestroyBufferView};
    }
}

void Buffer::upload(Queue& queue, std::span<const std::byte> data, uint64_t offset) {
    if (data.empty()) return;
    if (mapped_) {
        std::memcpy(mapped_ + offset, data.data(), data.size());
        return;
    }
    Staging staging(*device_, data.size());
    std::memcpy(staging.mapped, data.data(), data.size());
    queue.run("upload a buffer", [&](VkCommandBuffer commands) {
        const VkBufferCopy region = {0, offset, data.size()};
        device_->vk().vkCmdCopyBuffer(commands, staging.buffer.get(), buffer_.get(), 1, &region);
        fullBarrier(*device_, commands);
    });
}

void Buffer::download(Queue& queue, std::span<std::byte> data, uint64_t offset) const {
    if (data.empty()) return;
    if (mapped_) {
        std::memcpy(data.data(), mapped_ + offset, data.size());
        return;
    }
    Staging staging(*device_, data.size());
    queue.run("download a buffer", [&](VkCommandBuffer commands) {
        const VkBufferCopy region = {offset, 0, data.size()};
        device_->vk().vkCmdCopyBuffer(commands, buffer_.get(), staging.buffer.get(), 1, &region);
        fullBarrier(*device_, commands);
    });
    std::memcpy(data.data(), staging.mapped, data.size());
}

} // namespace stromboli::vulkan
