#pragma once

#include "host/vulkan/buffer_limits.hpp"
#include "host/vulkan/device_memory.hpp"
#include "host/vulkan/handle.hpp"
#include "host/vulkan/queue.hpp"

#include <span>
#include <string>

namespace stromboli::vulkan {

/// A buffer in the device's memory. Where that is the host's memory it is mapped; elsewhere
/// uploads and downloads go through a staging buffer.
class Buffer {
  public:
    /// `name` is for error messages. An empty buffer gets 16 bytes: Vulkan has none of size 0.
    /// Throws DeviceError as requireFits does, and if the driver has no memory left.
    Buffer(const Device& device, std::string name, uint64_t bytes, BufferUse use);

    VkBuffer handle() const { return buffer_.get(); }
    VkBufferView view() const { return view_.get(); } ///< Texel only
    uint64_t bytes() const { return bytes_; }
    BufferUse use() const { return use_; }

    /// Sets every byte to zero.
    void clear(Queue& queue);
    void upload(Queue& queue, std::span<const std::byte> data, uint64_t offset = 0);
    void download(Queue& queue, std::span<std::byte> data, uint64_t offset = 0) const;
    /// The buffer's bytes where the device's memory is the host's; else null. To be read between
    /// two dispatches.
    const std::byte* hostView() const { return memory_.mapped(); }

  private:
    const Device* device_;
    std::string name_;
    uint64_t bytes_;
    BufferUse use_;
    DeviceMemory memory_; ///< declared first: freed last
    Handle<VkBuffer> buffer_;
    Handle<VkBufferView> view_;
};

} // namespace stromboli::vulkan
