#pragma once

#include "host/core/pages.hpp"
#include "host/vulkan/device.hpp"
#include "host/vulkan/instance.hpp"
#include "host/vulkan/queue.hpp"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <utility>

namespace stromboli::vulkan {

// --- Memory of a device --------------------------------------------------------------------------

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
    /// Pages of the host, which must outlive the object. Null: the driver does not take them.
    static std::optional<DeviceMemory> ofHost(const Device& device, VkBuffer buffer,
                                              std::span<const std::byte> wholePages,
                                              const std::string& name);
    ~DeviceMemory();
    DeviceMemory(DeviceMemory&& other) noexcept { *this = std::move(other); }
    DeviceMemory& operator=(DeviceMemory&& other) noexcept;

    /// Null unless in MemoryPlace::Host; null for pages of the host's own.
    std::byte* mapped() const { return mapped_; }
    /// What the driver asks for a buffer: its size rounded up to the driver's alignment.
    uint64_t bytes() const { return bytes_; }

  private:
    const Device* device_ = nullptr;
    Handle<VkDeviceMemory> memory_;
    uint64_t bytes_ = 0;
    std::byte* mapped_ = nullptr;
};

// --- Limits of buffers ---------------------------------------------------------------------------

enum class BufferUse {
    Storage, ///< storage buffer
    Texel,   ///< storage texel buffer of RGBA32UI rows
    Uniform, ///< uniform buffer
};

/// A buffer before it is made.
struct BufferPlan {
    std::string name; ///< for messages
    uint64_t bytes = 0;
    BufferUse use = BufferUse::Storage;
    std::string remedy;     ///< what the user can do where it does not fit; may be empty
    bool isInPages = false; ///< its contents are a PageVector
};

/// The most bytes of one buffer that a shader can reach through one binding of this kind, and the
/// name of the limit in Vulkan.
struct BindingLimit {
    uint64_t bytes = 0;
    const char* name = "";
};
BindingLimit bindingLimit(const DeviceDescription& device, BufferUse use);

/// Throws DeviceError, naming the buffer, both sizes and the limit, if the buffer does not fit one
/// binding, one allocation or the device's memory.
void requireFits(const DeviceDescription& device, const BufferPlan& buffer);

/// Throws DeviceError, naming the limit, what is needed and what there is, if a shader cannot have
/// that many buffers of each kind. Storage texel buffers count as storage images.
void requireBindable(const DeviceDescription& device, std::span<const BufferUse> buffers);

/// True if requireBindable would not throw.
bool areBindable(const DeviceDescription& device, std::span<const BufferUse> buffers);

/// Throws DeviceError that lists the buffers if they do not fit the device's memory together.
void requireTogetherFit(const DeviceDescription& device, std::span<const BufferPlan> buffers);

// --- Buffers -------------------------------------------------------------------------------------

/// A buffer in the device's memory. Where that is the host's memory it is mapped; elsewhere
/// uploads and downloads go through a staging buffer.
class Buffer {
  public:
    /// `name` is for error messages. An empty buffer gets 16 bytes: Vulkan has none of size 0.
    /// Throws DeviceError as requireFits does, and if the driver has no memory left.
    Buffer(const Device& device, std::string name, uint64_t bytes, BufferUse use);
    /// A buffer with the contents of a PageVector. Where the device can, it reads them where they
    /// lie (readsHost()): then they must outlive the buffer, and neither they nor the buffer
    /// change.
    template <class T>
    Buffer(const Device& device, std::string name, const PageVector<T>& contents, BufferUse use)
        : Buffer(device, std::move(name), std::as_bytes(std::span(contents)), use) {}

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
    /// Whether its memory is that of an array of the host.
    bool readsHost() const { return readsHost_; }

  private:
    Buffer(const Device& device, std::string name, std::span<const std::byte> wholePages,
           BufferUse use);

    const Device* device_;
    std::string name_;
    uint64_t bytes_;
    BufferUse use_;
    bool readsHost_ = false;
    DeviceMemory memory_; ///< declared first: freed last
    Handle<VkBuffer> buffer_;
    Handle<VkBufferView> view_;
};

} // namespace stromboli::vulkan
