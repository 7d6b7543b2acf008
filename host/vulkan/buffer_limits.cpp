#include "host/vulkan/buffer_limits.hpp"

#include "host/core/error.hpp"
#include "shaders/shared/interface.h"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace stromboli::vulkan {
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

} // namespace stromboli::vulkan
