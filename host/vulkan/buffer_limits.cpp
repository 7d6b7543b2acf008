#include "host/vulkan/buffer_limits.hpp"

#include "host/core/error.hpp"
#include "shaders/shared/interface.h"

#include <fmt/format.h>

namespace stromboli::vulkan {
namespace {

constexpr uint64_t kRowBytes = 16; // one RGBA32UI texel
constexpr uint32_t kMostRows = gpu::TEXEL_ROW_MASK + 1;

} // namespace

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
        throw DeviceError(fmt::format("the {} needs {} bytes, but {} {}", buffer.name, buffer.bytes,
                                      device.name(), why));
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
    uint64_t total = 0;
    std::string list;
    for (const BufferPlan& buffer : buffers) {
        total += buffer.bytes;
        list += fmt::format("{}{} {}", list.empty() ? "" : ", ", buffer.name, buffer.bytes);
    }
    if (total > device.memory)
        throw DeviceError(
            fmt::format("the buffers need {} bytes together, but {} has {} bytes of memory: {}",
                        total, device.name(), device.memory, list));
}

} // namespace stromboli::vulkan
