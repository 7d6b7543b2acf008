#include "host/kernel/path_kernel.hpp"

#include "embedded/pathtrace_storage.h"
#include "embedded/pathtrace_texel.h"
#include "embedded/wavefront_storage.h"
#include "embedded/wavefront_texel.h"
#include "shaders/shared/interface.h"
#include "shaders/shared/render_types.h"
#include "shaders/shared/wavefront_types.h"

namespace stromboli {
namespace {

using vulkan::BufferUse;

std::vector<vulkan::Binding> kernelBindings(bool texelFetch, bool isStage) {
    std::vector<vulkan::Binding> bindings;
    for (uint32_t i = 0; i < BINDING_COUNT; ++i) {
        if (i == BINDING_QUEUES && !isStage) continue;
        // The film and the work list are read and written row by row as well.
        const bool rows = i < SCENE_BINDING_COUNT || i == BINDING_WORK_ITEMS ||
                          i == BINDING_PIXELS || i == BINDING_FILTER;
        bindings.push_back({i, rows && texelFetch   ? BufferUse::Texel
                               : i == BINDING_FRAME ? BufferUse::Uniform
                                                    : BufferUse::Storage});
    }
    return bindings;
}

std::span<const uint32_t> moduleFor(bool texelFetch, bool isStage) {
    if (isStage) {
        if (texelFetch) return wavefront_texel;
        return wavefront_storage;
    }
    if (texelFetch) return pathtrace_texel;
    return pathtrace_storage;
}

std::vector<uint32_t> constantsOf(const KernelFeatures& features, std::optional<uint32_t> stage) {
    std::vector<uint32_t> constants(features.begin(), features.end());
    static_assert(SPEC_STAGE == SPEC_COUNT);
    if (stage) constants.push_back(*stage);
    return constants;
}

} // namespace

PathKernel::PathKernel(const vulkan::Device& device, const KernelFeatures& features,
                       bool texelFetch, vulkan::Specialiser specialiser,
                       std::optional<uint32_t> stage)
    : features_(features),
      pipeline_(device, moduleFor(texelFetch, stage.has_value()),
                kernelBindings(texelFetch, stage.has_value()), constantsOf(features, stage),
                sizeof(gpu::Dispatch), specialiser) {}

} // namespace stromboli
