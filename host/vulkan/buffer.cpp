#include "host/vulkan/buffer.hpp"

#include "host/vulkan/result.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstring>
#include <utility>

namespace stromboli::vulkan {
namespace {

/// The smallest buffer: one row of 16 bytes.
constexpr uint64_t kLeastBytes = 16;
/// A staging buffer's size at most: enough to keep a bus busy, little beside a scene.
constexpr uint64_t kStagingBytes = uint64_t(64) << 20;

constexpr VkBufferUsageFlags kCopies =
    VK_BUFFER_USAGE_TRANSFER_SRC_BIT | VK_BUFFER_USAGE_TRANSFER_DST_BIT;

VkBufferUsageFlags usageOf(BufferUse use) {
    switch (use) {
    case BufferUse::Texel:
        return kCopies | VK_BUFFER_USAGE_STORAGE_TEXEL_BUFFER_BIT;
    case BufferUse::Uniform:
        return kCopies | VK_BUFFER_USAGE_UNIFORM_BUFFER_BIT;
    default: // the queues of the wavefront scheduler are read by indirect dispatches as well
        return kCopies | VK_BUFFER_USAGE_STORAGE_BUFFER_BIT | VK_BUFFER_USAGE_INDIRECT_BUFFER_BIT;
    }
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

Handle<VkBufferView> createView(const Device& device, VkBuffer buffer, const std::string& name) {
    const VkBufferViewCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_VIEW_CREATE_INFO,
                                         .buffer = buffer,
                                         .format = VK_FORMAT_R32G32B32A32_UINT,
                                         .range = VK_WHOLE_SIZE};
    VkBufferView view = VK_NULL_HANDLE;
    check(device.vk().vkCreateBufferView(device.handle(), &info, nullptr, &view),
          fmt::format("create a view of the {}", name));
    return {device.handle(), view, device.vk().vkDestroyBufferView};
}

/// Host memory for the pieces of one copy.
class Staging {
  public:
    Staging(const Device& device, uint64_t bytes)
        : device_(device), bytes_(std::min(bytes, kStagingBytes)),
          buffer_(createBuffer(device, bytes_, kCopies, "staging buffer")) {
        memory_ = DeviceMemory(device, buffer_.get(), MemoryPlace::Host, "staging buffer");
    }

    /// Calls use(first, count) for each piece of `bytes`.
    template <class Use>
    void forEachPiece(uint64_t bytes, const Use& use) const {
        for (uint64_t first = 0; first < bytes; first += bytes_)
            use(first, std::min(bytes_, bytes - first));
    }

    void copy(Queue& queue, const char* what, VkBuffer from, uint64_t fromOffset, VkBuffer to,
              uint64_t toOffset, uint64_t bytes) const {
        queue.run(what, [&](VkCommandBuffer commands) {
            const VkBufferCopy region = {fromOffset, toOffset, bytes};
            device_.vk().vkCmdCopyBuffer(commands, from, to, 1, &region);
            fullBarrier(device_, commands);
        });
    }

    VkBuffer buffer() const { return buffer_.get(); }
    std::byte* mapped() const { return memory_.mapped(); }

  private:
    const Device& device_;
    uint64_t bytes_;
    DeviceMemory memory_; // declared first: freed last
    Handle<VkBuffer> buffer_;
};

} // namespace

Buffer::Buffer(const Device& device, std::string name, uint64_t bytes, BufferUse use)
    : device_(&device), name_(std::move(name)), bytes_(std::max(bytes, kLeastBytes)), use_(use) {
    requireFits(device.description(), {name_, bytes_, use});
    buffer_ = createBuffer(device, bytes_, usageOf(use), name_);
    const bool shared = device.description().sharesHostMemory();
    memory_ = DeviceMemory(device, buffer_.get(), shared ? MemoryPlace::Host : MemoryPlace::Device,
                           name_);
    if (use == BufferUse::Texel) view_ = createView(device, buffer_.get(), name_);
}

void Buffer::upload(Queue& queue, std::span<const std::byte> data, uint64_t offset) {
    if (data.empty()) return;
    device_->countUpload(data.size());
    if (std::byte* mapped = memory_.mapped()) {
        std::memcpy(mapped + offset, data.data(), data.size());
        return;
    }
    const Staging staging(*device_, data.size());
    staging.forEachPiece(data.size(), [&](uint64_t first, uint64_t count) {
        std::memcpy(staging.mapped(), data.data() + first, count);
        staging.copy(queue, "upload a buffer", staging.buffer(), 0, buffer_.get(), offset + first,
                     count);
    });
}

void Buffer::clear(Queue& queue) {
    if (std::byte* mapped = memory_.mapped()) {
        std::memset(mapped, 0, bytes_);
        return;
    }
    queue.run("clear a buffer", [&](VkCommandBuffer commands) {
        device_->vk().vkCmdFillBuffer(commands, buffer_.get(), 0, VK_WHOLE_SIZE, 0);
        fullBarrier(*device_, commands);
    });
}

void Buffer::download(Queue& queue, std::span<std::byte> data, uint64_t offset) const {
    if (data.empty()) return;
    if (const std::byte* mapped = memory_.mapped()) {
        std::memcpy(data.data(), mapped + offset, data.size());
        return;
    }
    const Staging staging(*device_, data.size());
    staging.forEachPiece(data.size(), [&](uint64_t first, uint64_t count) {
        staging.copy(queue, "download a buffer", buffer_.get(), offset + first, staging.buffer(), 0,
                     count);
        std::memcpy(data.data() + first, staging.mapped(), count);
    });
}

} // namespace stromboli::vulkan
