#pragma once

#include <volk.h>

#include <atomic>
#include <cstdint>

namespace stromboli::vulkan {

/// A Vulkan 1.1 instance without any window system. With validation, the Khronos layer checks
/// every call; its messages are logged and counted.
class Instance {
  public:
    /// Throws DeviceError if there is no Vulkan loader or (validation) no validation layer.
    explicit Instance(bool validation);
    ~Instance();
    Instance(const Instance&) = delete;
    Instance& operator=(const Instance&) = delete;

    VkInstance handle() const { return instance_; }
    bool validation() const { return messenger_ != VK_NULL_HANDLE; }
    /// Warnings and errors of the validation layer so far.
    uint32_t validationMessages() const { return messages_.load(); }

  private:
    VkInstance instance_ = VK_NULL_HANDLE;
    VkDebugUtilsMessengerEXT messenger_ = VK_NULL_HANDLE;
    std::atomic<uint32_t> messages_ = 0;
    // volk's are those of the instance that was made last, which may have no validation layer.
    PFN_vkDestroyInstance destroy_ = nullptr;
    PFN_vkDestroyDebugUtilsMessengerEXT destroyMessenger_ = nullptr;
};

/// True if the environment asks for validation: STROMBOLI_VALIDATION set and not 0.
bool validationRequested();

} // namespace stromboli::vulkan
