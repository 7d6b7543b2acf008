#pragma once

#include <volk.h>

#include <utility>

namespace stromboli::vulkan {

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

} // namespace stromboli::vulkan
