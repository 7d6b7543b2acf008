#include "host/vulkan/buffer.hpp"

#include "host/core/error.hpp"
#include "host/core/pages.hpp"
#include "shaders/shared/interface.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cstring>
#include <optional>
#include <utility>

namespace stromboli::vulkan {

// --- Memory of a device --------------------------------------------------------------------------

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

std::optional<DeviceMemory> DeviceMemory::ofHost(const Device& device, VkBuffer buffer,
                                                 std::span<const std::byte> pages,
                                                 const std::string& name) {
    VkMemoryRequirements needs;
    device.vk().vkGetBufferMemoryRequirements(device.handle(), buffer, &needs);
    // Vulkan has no pointer to what is only read.
    void* const pointer = const_cast<std::byte*>(pages.data());
    constexpr auto kKind = VK_EXTERNAL_MEMORY_HANDLE_TYPE_HOST_ALLOCATION_BIT_EXT;
    VkMemoryHostPointerPropertiesEXT host = {
        .sType = VK_STRUCTURE_TYPE_MEMORY_HOST_POINTER_PROPERTIES_EXT};
    const VkResult known =
        device.vk().vkGetMemoryHostPointerPropertiesEXT(device.handle(), kKind, pointer, &host);
    const uint32_t types = needs.memoryTypeBits & host.memoryTypeBits;
    const uint64_t bytes = wholePages(pages.size());
    if (known != VK_SUCCESS || types == 0 || needs.size > bytes) return std::nullopt;
    const VkImportMemoryHostPointerInfoEXT pointerInfo = {
        .sType = VK_STRUCTURE_TYPE_IMPORT_MEMORY_HOST_POINTER_INFO_EXT,
        .handleType = kKind,
        .pHostPointer = pointer};
    const VkMemoryAllocateInfo info = {.sType = VK_STRUCTURE_TYPE_MEMORY_ALLOCATE_INFO,
                                       .pNext = &pointerInfo,
                                       .allocationSize = bytes,
                                       .memoryTypeIndex = uint32_t(std::countr_zero(types))};
    VkDeviceMemory handle = VK_NULL_HANDLE;
    if (device.vk().vkAllocateMemory(device.handle(), &info, nullptr, &handle) != VK_SUCCESS)
        return std::nullopt;
    DeviceMemory memory;
    memory.memory_ = {device.handle(), handle, device.vk().vkFreeMemory};
    check(device.vk().vkBindBufferMemory(device.handle(), buffer, handle, 0),
          fmt::format("bind the {}", name));
    memory.device_ = &device;
    memory.bytes_ = needs.size;
    device.countAllocation(int64_t(memory.bytes_));
    return memory;
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

// --- Limits of buffers ---------------------------------------------------------------------------

namespace {

constexpr uint64_t kRowBytes = 16; // one RGBA32UI texel
constexpr uint32_t kMostRows = gpu::TEXEL_ROW_MASK + 1;

/// A number of buffers of one kind, and the limit it must keep.
struct BufferCount {
    const char* what;
    const char* limit;
    uint64_t needed;
    uint32_t allowed;
};

/// The first count that the device does not allow; nothing if it allows all.
std::optional<BufferCount> tooMany(const DeviceDescription& device,
                                   std::span<const BufferUse> buffers) {
    const VkPhysicalDeviceLimits& limits = device.properties.limits;
    const auto count = [&](BufferUse use) { return uint64_t(std::ranges::count(buffers, use)); };
    for (const BufferCount& c :
         {BufferCount{"storage buffers", "maxPerStageDescriptorStorageBuffers",
                      count(BufferUse::Storage), limits.maxPerStageDescriptorStorageBuffers},
          BufferCount{"storage texel buffers", "maxPerStageDescriptorStorageImages",
                      count(BufferUse::Texel), limits.maxPerStageDescriptorStorageImages},
          BufferCount{"uniform buffers", "maxPerStageDescriptorUniformBuffers",
                      count(BufferUse::Uniform), limits.maxPerStageDescriptorUniformBuffers},
          BufferCount{"buffers", "maxPerStageResources", buffers.size(),
                      limits.maxPerStageResources}})
        if (c.needed > c.allowed) return c;
    return std::nullopt;
}

} // namespace

void requireBindable(const DeviceDescription& device, std::span<const BufferUse> buffers) {
    if (const auto c = tooMany(device, buffers))
        throw DeviceError(fmt::format("the kernel needs {} {}, but {} allows a shader {} ({})",
                                      c->needed, c->what, device.name(), c->allowed, c->limit));
}

bool areBindable(const DeviceDescription& device, std::span<const BufferUse> buffers) {
    return !tooMany(device, buffers);
}

BindingLimit bindingLimit(const DeviceDescription& device, BufferUse use) {
    const VkPhysicalDeviceLimits& limits = device.properties.limits;
    switch (use) {
    case BufferUse::Texel:
        return limits.maxTexelBufferElements <= kMostRows
                   ? BindingLimit{uint64_t(limits.maxTexelBufferElements) * kRowBytes,
                                  "maxTexelBufferElements"}
                   : BindingLimit{uint64_t(kMostRows) * kRowBytes, "27 bits for the kernel's rows"};
    case BufferUse::Uniform:
        return {limits.maxUniformBufferRange, "maxUniformBufferRange"};
    default:
        return {limits.maxStorageBufferRange, "maxStorageBufferRange"};
    }
}

void requireFits(const DeviceDescription& device, const BufferPlan& buffer) {
    const auto refuse = [&](const std::string& why) {
        throw DeviceError(fmt::format("the {} needs {} bytes, but {} {}{}{}", buffer.name,
                                      buffer.bytes, device.name(), why,
                                      buffer.remedy.empty() ? "" : "; ", buffer.remedy));
    };
    const BindingLimit binding = bindingLimit(device, buffer.use);
    if (buffer.bytes > binding.bytes)
        refuse(fmt::format("allows {} ({})", binding.bytes, binding.name));
    if (buffer.bytes > device.largestAllocation)
        refuse(fmt::format("allocates at most {} at once (maxMemoryAllocationSize)",
                           device.largestAllocation));
    if (buffer.bytes > device.memory) refuse(fmt::format("has {} bytes of memory", device.memory));
}

void requireTogetherFit(const DeviceDescription& device, std::span<const BufferPlan> buffers) {
    uint64_t total = 0, most = 0;
    std::string list, remedy;
    for (const BufferPlan& buffer : buffers) {
        total += buffer.bytes;
        if (buffer.bytes > most) most = buffer.bytes, remedy = buffer.remedy;
        list += fmt::format("{}{} {}", list.empty() ? "" : ", ", buffer.name, buffer.bytes);
    }
    if (total > device.memory)
        throw DeviceError(fmt::format(
            "the buffers need {} bytes together, but {} has {} bytes of memory: {}{}{}", total,
            device.name(), device.memory, list, remedy.empty() ? "" : "; ", remedy));
}

// --- Buffers -------------------------------------------------------------------------------------

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
                              const std::string& name, bool readsHost = false) {
    const VkExternalMemoryBufferCreateInfo external = {
        .sType = VK_STRUCTURE_TYPE_EXTERNAL_MEMORY_BUFFER_CREATE_INFO,
        .handleTypes = VK_EXTERNAL_MEMORY_HANDLE_TYPE_HOST_ALLOCATION_BIT_EXT};
    const VkBufferCreateInfo info = {.sType = VK_STRUCTURE_TYPE_BUFFER_CREATE_INFO,
                                     .pNext = readsHost ? &external : nullptr,
                                     .size = bytes,
                                     .usage = usage};
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

Buffer::Buffer(const Device& device, std::string name, std::span<const std::byte> pages,
               BufferUse use)
    : device_(&device), name_(std::move(name)), bytes_(pages.size()), use_(use) {
    if (device.description().readsHostPages && bytes_ >= kPageBytes) {
        requireFits(device.description(), {name_, bytes_, use});
        buffer_ = createBuffer(device, bytes_, usageOf(use), name_, true);
        if (auto memory = DeviceMemory::ofHost(device, buffer_.get(), pages, name_)) {
            memory_ = std::move(*memory);
            readsHost_ = true;
            if (use == BufferUse::Texel) view_ = createView(device, buffer_.get(), name_);
            return;
        }
    }
    *this = Buffer(device, name_, bytes_, use);
    Queue queue(device);
    upload(queue, pages);
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
