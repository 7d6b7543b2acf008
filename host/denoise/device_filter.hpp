#pragma once

#include "host/denoise/prepare.hpp"
#include "host/vulkan/buffer.hpp"
#include "host/vulkan/compute_pipeline.hpp"
#include "host/vulkan/queue.hpp"
#include "shaders/shared/denoise_types.h"

#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

namespace stromboli::denoise {

/// How the work is cut. None of it changes a byte of the result.
struct FilterTuning {
    std::optional<bool> texelFetch;   ///< empty: where storage texel buffers are the faster ones
    uint32_t pixelsAtOnce = 1u << 20; ///< that buffers hold, 390 bytes for each
};

/// The filter on a device: the five shaders of shaders/denoise, one after the other, for strips of
/// rows. docs/theory/denoising.md says what they compute.
class DeviceFilter {
  public:
    /// The device must outlive the object. Throws DeviceError.
    explicit DeviceFilter(const vulkan::Device& device, const FilterTuning& tuning = {});

    /// By pixel; radiance is over albedo, as in `picture`. isUnwanted: asked between dispatches,
    /// which are short then; where it says so, nothing is returned. Throws DeviceError.
    std::vector<gpu::DenoiseResult> run(const Prepared& picture,
                                        const std::function<bool()>& isUnwanted = {});

  private:
    /// Rows of the picture.
    struct Rows {
        uint32_t first = 0, end = 0;
        uint32_t count() const { return end - first; }
    };
    struct Pass {
        vulkan::ComputePipeline pipeline;
        vulkan::DescriptorSet set;
    };
    struct Buffers;

    Rows around(Rows rows, uint32_t reach, uint32_t height) const;
    bool runStrip(const Prepared& picture, Rows rows, Buffers& buffers,
                  const std::function<bool()>& isUnwanted,
                  std::vector<gpu::DenoiseResult>& results);

    const vulkan::Device& device_;
    FilterTuning tuning_;
    bool texelFetch_;
    vulkan::Queue queue_;
    std::vector<gpu::DenoiseTap> taps_;
    std::vector<vulkan::ComputePipeline> pipelines_; ///< in the order of the passes
};

} // namespace stromboli::denoise
