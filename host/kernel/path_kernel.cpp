#include "host/kernel/path_kernel.hpp"

#include "host/kernel/kernel_modules.hpp"
#include "shaders/shared/interface.h"
#include "shaders/shared/render_types.h"

namespace stromboli {
namespace {

using vulkan::BufferUse;

std::vector<vulkan::Binding> kernelBindings(bool texelFetch) {
    std::vector<vulkan::Binding> bindings;
    for (uint32_t i = 0; i < BINDING_COUNT; ++i) {
        // The film and the work list are read and written row by row as well.
        const bool rows = i < SCENE_BINDING_COUNT || i == BINDING_WORK_ITEMS ||
                          i == BINDING_PIXELS || i == BINDING_FILTER;
        bindings.push_back({i, rows && texelFetch   ? BufferUse::Texel
                               : i == BINDING_FRAME ? BufferUse::Uniform
                                                    : BufferUse::Storage});
    }
    return bindings;
}

} // namespace

PathKernel::PathKernel(const vulkan::Device& device, const KernelFeatures& features,
                       bool texelFetch, std::span<const uint32_t> code)
    : features_(features),
      pipeline_(device, code.empty() ? kernelModule(features, texelFetch) : code,
                kernelBindings(texelFetch), features, sizeof(gpu::Dispatch)) {}

} // namespace stromboli
