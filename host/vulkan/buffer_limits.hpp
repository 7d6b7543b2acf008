#pragma once

#include "host/vulkan/device.hpp"

#include <cstdint>
#include <span>
#include <string>

namespace stromboli::vulkan {

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
    std::string remedy; ///< what the user can do where it does not fit; may be empty
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

} // namespace stromboli::vulkan
