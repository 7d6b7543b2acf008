#pragma once

#include "host/kernel/kernel_features.hpp"
#include "host/kernel/kernel_tuning.hpp"
#include "host/vulkan/compute_pipeline.hpp"

#include <optional>

namespace stromboli {

/// The path kernel, compiled with the features that a picture needs.
class PathKernel {
  public:
    /// stage: of the wavefront scheduler (STAGE_, shaders/shared/wavefront_types.h); none: the
    /// kernel of the persistent scheduler.
    PathKernel(const vulkan::Device& device, const KernelFeatures& features, bool texelFetch,
               vulkan::Specialiser specialiser, std::optional<uint32_t> stage = {});

    const KernelFeatures& features() const { return features_; }
    const vulkan::ComputePipeline& pipeline() const { return pipeline_; }

  private:
    KernelFeatures features_;
    vulkan::ComputePipeline pipeline_;
};

} // namespace stromboli
