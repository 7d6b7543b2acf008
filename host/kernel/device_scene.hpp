#pragma once

#include "host/kernel/gpu_scene.hpp"
#include "host/kernel/kernel_tuning.hpp"
#include "host/vulkan/buffer.hpp"

#include <cstdint>
#include <map>
#include <vector>

namespace stromboli {

/// Buffers that hold what a scene has for these bindings already.
using SceneBuffers = std::map<uint32_t, vulkan::Buffer>;

/// A scene in the device's memory: uploaded once, for all pictures of it.
class DeviceScene {
  public:
    /// `scene` must outlive the object. filled: of the same device; the others are uploaded. Throws
    /// DeviceError if a buffer is over a limit of the device.
    DeviceScene(const vulkan::Device& device, const GpuScene& scene, const DeviceTuning& tuning,
                SceneBuffers filled = {});

    /// Gives away the buffers in which the next scene has the same bytes, and frees the others: the
    /// object has none after that.
    SceneBuffers releaseWhatIsAlsoIn(const GpuScene& next);

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
