#pragma once

#include <volk.h>

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace stromboli::vulkan {

/// What a device promises of arithmetic with floats of 32 bits where a shader asks for it
/// (VK_KHR_shader_float_controls). Vulkan by itself leaves drivers free to take NaN, infinity and
/// the sign of zero for impossible, and to round to either neighbour.
struct FloatControls {
    bool preservesSpecialValues = false; ///< SignedZeroInfNanPreserve
    bool roundsToEven = false;           ///< RoundingModeRTE
    bool any() const { return preservesSpecialValues || roundsToEven; }
};

/// What the device has, if it has the extension.
FloatControls floatControlsOf(VkPhysicalDevice device);

/// For people: "NaN, infinity and -0 kept, rounding to nearest even".
std::string inWords(const FloatControls& controls);

/// The SPIR-V module, asking for these promises at each of its entry points. GLSL has no words for
/// them, and a module that asks is valid only where the device has them, so this is done when it is
/// known which device it is. A module that is none comes back as it was.
std::vector<uint32_t> withFloatControls(std::span<const uint32_t> spirv,
                                        const FloatControls& controls);

} // namespace stromboli::vulkan
