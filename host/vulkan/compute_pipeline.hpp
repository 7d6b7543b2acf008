#pragma once

#include "host/vulkan/buffer.hpp"
#include "host/vulkan/device.hpp"

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace stromboli::vulkan {

// --- Compute pipelines ---------------------------------------------------------------------------

struct Binding {
    uint32_t number = 0;
    BufferUse use = BufferUse::Storage;
};

struct CompiledPipeline {
    std::vector<Binding> bindings;
    Handle<VkDescriptorSetLayout> setLayout;
    Handle<VkPipelineLayout> layout;
    Handle<VkPipeline> pipeline;
};

/// Who puts the constants into a module: this program, before the driver reads it (host/spirv), or
/// the driver, which reads the whole module first. The kernel computes the same either way.
enum class Specialiser { Ours, Drivers };

/// A compute shader specialised and ready to run, with the layout of its one descriptor set. Those
/// that are made alike on one device are one and the same (KeptPipelines).
class ComputePipeline {
  public:
    /// Throws DeviceError if the device does not allow that many buffers of a kind.
    /// `constants[i]` is specialisation constant i (32-bit words; bool as 0 or 1).
    ComputePipeline(const Device& device, std::span<const uint32_t> spirv,
                    std::span<const Binding> bindings, std::span<const uint32_t> constants,
                    uint32_t pushConstantBytes, Specialiser specialiser = Specialiser::Ours);

    VkPipeline handle() const { return compiled_->pipeline.get(); }
    VkPipelineLayout layout() const { return compiled_->layout.get(); }
    VkDescriptorSetLayout setLayout() const { return compiled_->setLayout.get(); }
    std::span<const Binding> bindings() const { return compiled_->bindings; }

  private:
    std::shared_ptr<const CompiledPipeline> compiled_;
};

/// Buffers bound to a pipeline's set, in the order of its bindings.
class DescriptorSet {
  public:
    DescriptorSet(const Device& device, const ComputePipeline& pipeline,
                  std::span<const Buffer* const> buffers);
    VkDescriptorSet handle() const { return set_; }

  private:
    Handle<VkDescriptorPool> pool_;
    VkDescriptorSet set_ = VK_NULL_HANDLE; ///< the pool's
};

/// Records a dispatch of `groups` workgroups along x and a barrier after it.
void recordDispatch(const Device& device, VkCommandBuffer commands, const ComputePipeline& pipeline,
                    const DescriptorSet& set, std::span<const std::byte> pushConstants,
                    uint32_t groups);
/// Records a dispatch of as many groups as `counts` says, whose VkDispatchIndirectCommand is
/// `offset` bytes in.
void recordIndirectDispatch(const Device& device, VkCommandBuffer commands,
                            const ComputePipeline& pipeline, const DescriptorSet& set,
                            std::span<const std::byte> pushConstants, const Buffer& counts,
                            uint64_t offset);

// --- What the driver made of them ----------------------------------------------------------------

/// What a driver says of the machine code that it has made of a kernel.
struct PipelineStatistic {
    std::string name; ///< the driver's words, such as "VGPRs" or "Spilled VGPRs"
    double value = 0;
};

/// In the driver's order. The device is one that was opened for compiling (DeviceUse). Throws
/// DeviceError.
std::vector<PipelineStatistic> statisticsOf(const Device& device, VkPipeline pipeline);

} // namespace stromboli::vulkan
