#pragma once

#include "host/kernel/gpu_scene.hpp"
#include "host/kernel/kernel_tuning.hpp"
#include "host/vulkan/buffer.hpp"

#include <vector>

namespace stromboli {

/// A scene in the device's memory: uploaded once, for all pictures of it.
class DeviceScene {
  public:
    /// `scene` must outlive the object. Throws DeviceError if a buffer is over a limit of the
    /// device.
    DeviceScene(const vulkan::Device& device, const GpuScene& scene, const DeviceTuning& tuning);

    const GpuScene& scene() const { return scene_; }
    /// How its rows are read: as DeviceTuning::texelFetch was when it was uploaded.
    bool isFetchedAsTexels() const { return isFetchedAsTexels_; }
    /// In the order of their bindings, which are the first of the kernel's.
    const std::vector<vulkan::Buffer>& buffers() const { return buffers_; }

  private:
    const GpuScene& scene_;
    bool isFetchedAsTexels_;
    std::vector<vulkan::Buffer> buffers_;
};

} // namespace stromboli
