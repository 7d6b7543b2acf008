#pragma once

#include "host/film/film.hpp"
#include "host/kernel/gpu_scene.hpp"
#include "host/kernel/kernel_features.hpp"
#include "host/kernel/kernel_tuning.hpp"
#include "host/render/estimator.hpp"
#include "host/vulkan/buffer.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace stromboli {

/// How buffers that are read row by row are bound.
vulkan::BufferUse rowUse(const DeviceTuning& tuning);

/// The scene's buffers, in the order of their bindings.
std::vector<vulkan::BufferPlan> planSceneBuffers(const GpuScene& scene, const DeviceTuning& tuning);

/// Bytes of the largest buffer of the scene.
uint64_t largestSceneBuffer(const GpuScene& scene);
/// Bytes of the largest buffer that the path kernel reads row by row and that cannot be cut into
/// parts: of the scene, or the work list of a picture of so many pixels.
uint64_t largestRowBuffer(const GpuScene& scene, uint64_t pixels);

/// All device buffers of a scene and a picture, known before anything is allocated: the driver adds
/// no more than its alignment to each. The film may be several buffers (pixelsPerSegment).
std::vector<vulkan::BufferPlan> planBuffers(const GpuScene& scene, const PictureArea& area,
                                            const Estimator& estimator, const DeviceTuning& tuning);

/// Pixels of the film that fit one buffer and one binding.
uint64_t pixelsPerSegment(const vulkan::DeviceDescription& device, const DeviceTuning& tuning);

/// Pixels of the film for which the device has memory beside the scene.
uint64_t filmPixelsThatFit(const vulkan::DeviceDescription& device, const GpuScene& scene,
                           const Estimator& estimator);

/// Whether the device has room for the scene's textures, as they were packed. Where it has not,
/// packing them plainly (gatheredRows 0) takes a quarter of the memory.
bool haveRoomForTextures(const vulkan::DeviceDescription& device, const GpuScene& scene);

/// Throws DeviceError that names what does not fit, before anything is allocated or uploaded.
void checkMemory(const vulkan::DeviceDescription& device, const GpuScene& scene,
                 const PictureArea& area, const Estimator& estimator, const DeviceTuning& tuning);

/// What a scheduler keeps of paths between two dispatches (BINDING_PATHS, BINDING_QUEUES).
struct PathBuffers {
    vulkan::BufferPlan paths;
    std::optional<vulkan::BufferPlan> queues; ///< of the wavefront scheduler
};
PathBuffers pathBuffers(const KernelFeatures& features, uint64_t lanes, PathScheduler scheduler);

} // namespace stromboli
