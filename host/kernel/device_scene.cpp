#include "host/kernel/device_scene.hpp"

#include "host/kernel/kernel_buffers.hpp"
#include "shaders/shared/interface.h"

#include <algorithm>
#include <array>
#include <span>
#include <utility>

namespace stromboli {
namespace {

template <class T>
std::span<const std::byte> bytesOf(const std::vector<T>& v) {
    return std::as_bytes(std::span(v));
}

constexpr size_t kBuffers = 7;

/// What a scene has for each of its bindings.
std::array<std::span<const std::byte>, kBuffers> contentsOf(const GpuScene& scene) {
    std::array<std::span<const std::byte>, kBuffers> contents;
    contents[BINDING_RECORDS] = bytesOf(scene.bvh.records);
    contents[BINDING_PRIMITIVES] = bytesOf(scene.primitives);
    contents[BINDING_MATERIALS] = bytesOf(scene.materials);
    contents[BINDING_LIGHTS] = bytesOf(scene.lights.lights);
    contents[BINDING_LIGHT_TABLE] = bytesOf(scene.lights.table);
    contents[BINDING_ENVIRONMENT] = std::as_bytes(scene.lights.environmentRows());
    contents[BINDING_DETAIL] = bytesOf(scene.details);
    return contents;
}

bool areSame(std::span<const std::byte> a, std::span<const std::byte> b) {
    return a.data() == b.data() ? a.size() == b.size() : std::ranges::equal(a, b);
}

} // namespace

DeviceScene::DeviceScene(const vulkan::Device& device, const GpuScene& scene,
                         const DeviceTuning& tuning, SceneBuffers filled)
    : scene_(scene), isFetchedAsTexels_(tuning.texelFetch) {
    vulkan::Queue queue(device);
    const auto contents = contentsOf(scene);
    const std::vector<vulkan::BufferPlan> plans = planSceneBuffers(scene, tuning);
    for (uint32_t binding = 0; binding < kBuffers; ++binding) {
        const vulkan::BufferPlan& plan = plans.at(binding);
        const auto found = filled.find(binding);
        if (found != filled.end() && found->second.use() == plan.use) {
            buffers_.push_back(std::move(found->second));
            continue;
        }
        filled.erase(binding); // before the memory of the next is asked for
        buffers_.emplace_back(device, plan.name, plan.bytes, plan.use);
        buffers_.back().upload(queue, contents[binding]);
    }
}

SceneBuffers DeviceScene::releaseWhatIsAlsoIn(const GpuScene& next) {
    SceneBuffers filled;
    const auto contents = contentsOf(scene_), others = contentsOf(next);
    for (uint32_t binding = 0; binding < kBuffers; ++binding)
        if (areSame(contents[binding], others[binding]))
            filled.emplace(binding, std::move(buffers_[binding]));
    buffers_.clear();
    return filled;
}

} // namespace stromboli
