#pragma once

#include "host/core/messages.hpp"

#include <volk.h>

#include <atomic>
#include <cstdint>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace stromboli::vulkan {

// --- Handles -------------------------------------------------------------------------------------

/// Owns one Vulkan object of a device. T is a handle type, destroyed by the function given.
template <class T>
class Handle {
  public:
    using Destroy = void(VKAPI_PTR*)(VkDevice, T, const VkAllocationCallbacks*);

    Handle() = default;
    Handle(VkDevice device, T handle, Destroy destroy)
        : device_(device), handle_(handle), destroy_(destroy) {}
    ~Handle() {
        if (handle_ != VK_NULL_HANDLE) destroy_(device_, handle_, nullptr);
    }
    Handle(Handle&& other) noexcept { *this = std::move(other); }
    Handle& operator=(Handle&& other) noexcept {
        std::swap(device_, other.device_);
        std::swap(handle_, other.handle_);
        std::swap(destroy_, other.destroy_);
        return *this;
    }
    Handle(const Handle&) = delete;
    Handle& operator=(const Handle&) = delete;

    T get() const { return handle_; }
    explicit operator bool() const { return handle_ != VK_NULL_HANDLE; }

  private:
    VkDevice device_ = VK_NULL_HANDLE;
    T handle_ = VK_NULL_HANDLE;
    Destroy destroy_ = nullptr;
};

// --- Results of calls ----------------------------------------------------------------------------

/// Throws DeviceError (DeviceLostError for a lost device), naming the operation and the VkResult,
/// unless result is VK_SUCCESS.
void check(VkResult result, std::string_view operation);

// --- The instance --------------------------------------------------------------------------------

/// A Vulkan 1.1 instance without any window system. With validation, the Khronos layer checks
/// every call; its messages are counted, and told as errors, on any thread that calls Vulkan.
class Instance {
  public:
    /// Throws DeviceError if there is no Vulkan loader or (validation) no validation layer.
    explicit Instance(bool validation, Messages messages = {});
    ~Instance();
    Instance(const Instance&) = delete;
    Instance& operator=(const Instance&) = delete;

    VkInstance handle() const { return instance_; }
    bool validation() const { return messenger_ != VK_NULL_HANDLE; }
    /// Warnings and errors of the validation layer so far.
    uint32_t validationMessages() const { return complaints_.count.load(); }

    /// What the validation layer says goes here.
    struct Complaints {
        std::atomic<uint32_t> count = 0;
        Messages messages;
    };

  private:
    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    Complaints complaints_;
    // volk's are those of the instance that was made last, which may have no validation layer.
    PFN_vkDestroyInstance destroy_ = nullptr;
    PFN_vkDestroyDebugUtilsMessengerEXT destroyMessenger_ = nullptr;
};

/// True if the environment asks for validation: STROMBOLI_VALIDATION set and not 0.
bool validationRequested();

// --- Float controls ------------------------------------------------------------------------------

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
