#include "host/kernel/device_scene.hpp"

#include "host/kernel/kernel_buffers.hpp"
#include "shaders/shared/interface.h"

#include <span>

namespace stromboli {
namespace {

template <class T>
std::span<const std::byte> bytesOf(const std::vector<T>& v) {
    return std::as_bytes(std::span(v));
}

} // namespace

DeviceScene::DeviceScene(const vulkan::Device& device, const GpuScene& scene,
                         const DeviceTuning& tuning)
    : scene_(scene), isFetchedAsTexels_(tuning.texelFetch) {
    vulkan::Queue queue(device);
    for (const vulkan::BufferPlan& b : planSceneBuffers(scene, tuning))
        buffers_.emplace_back(device, b.name, b.bytes, b.use);
    buffers_[BINDING_RECORDS].upload(queue, bytesOf(scene.bvh.records));
    buffers_[BINDING_PRIMITIVES].upload(queue, bytesOf(scene.primitives));
    buffers_[BINDING_MATERIALS].upload(queue, bytesOf(scene.materials));
    buffers_[BINDING_LIGHTS].upload(queue, bytesOf(scene.lights.lights));
    buffers_[BINDING_LIGHT_TABLE].upload(queue, bytesOf(scene.lights.table));
    buffers_[BINDING_ENVIRONMENT].upload(queue, std::as_bytes(scene.lights.environmentRows()));
    buffers_[BINDING_DETAIL].upload(queue, bytesOf(scene.details));
}

} // namespace stromboli
