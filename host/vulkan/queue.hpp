#pragma once

#include "host/vulkan/device.hpp"
#include "host/vulkan/instance.hpp"

#include <functional>

namespace stromboli::vulkan {

/// Records and runs command buffers one at a time, waiting for each.
class Queue {
  public:
    explicit Queue(const Device& device);
    ~Queue();
    Queue(const Queue&) = delete;
    Queue& operator=(const Queue&) = delete;

    /// Records with `record`, submits and waits. Returns the time the device took, in seconds:
    /// by timestamps where the queue has them, else by the host's clock.
    /// Throws DeviceError (device lost, out of memory), naming `what`.
    double run(const char* what, const std::function<void(VkCommandBuffer)>& record);

  private:
    const Device& device_;
    Handle<VkCommandPool> pool_;
    VkCommandBuffer commands_ = VK_NULL_HANDLE; ///< the pool's
    Handle<VkFence> fence_;
    Handle<VkQueryPool> timestamps_; ///< empty: the queue has none
};

/// All writes of shaders and transfers before it are visible to all that follows, the host too.
void fullBarrier(const Device& device, VkCommandBuffer commands);

} // namespace stromboli::vulkan
