#include "host/kernel/path_kernel.hpp"

#include "embedded/pathtrace_storage.h"
#include "embedded/pathtrace_texel.h"
#include "embedded/wavefront_storage.h"
#include "embedded/wavefront_texel.h"
#include "shaders/shared/interface.h"
#include "shaders/shared/medium_types.h"
#include "shaders/shared/parameters.h"
#include "shaders/shared/path_fields.h"
#include "shaders/shared/render_types.h"
#include "shaders/shared/texture_types.h"
#include "shaders/shared/wavefront_types.h"

namespace stromboli {

// --- Words of a path -----------------------------------------------------------------------------

namespace {

/// The features by their names, and what the shaders derive from them: a field exists where an
/// expression of these says so.
struct FieldConditions {
#define NAME_FEATURE(number, type, name, standard, value, all, label, shown, adds) uint32_t name;
    KERNEL_FEATURES(NAME_FEATURE)
#undef NAME_FEATURE
    bool SEES_SURFACES;

    explicit FieldConditions(const KernelFeatures& f) {
#define SET_FEATURE(number, type, name, standard, value, all, label, shown, adds) name = f[number];
        KERNEL_FEATURES(SET_FEATURE)
#undef SET_FEATURE
        SEES_SURFACES = INTEGRATOR == gpu::INTEGRATOR_LAYERS;
    }

    bool sceneHas(uint32_t bits) const {
        return (CLOSURES & bits) != 0;
    }
    bool sceneHasSlot(uint32_t slot) const {
        return (TEXTURE_SLOTS & 1u << slot) != 0;
    }
    bool samplesHaveWeights() const {
        return PIXEL_FILTER == gpu::FILTER_TABLE;
    }
    bool endsByThroughput() const {
        return ROULETTE == gpu::ROULETTE_THROUGHPUT;
    }
    bool emissionHasFactors() const {
        return sceneHasSlot(gpu::TEXTURE_EMISSION) || HAS_ALPHA != 0;
    }
    bool samplesLightKind(uint32_t kind) const {
        return (LIGHT_KINDS & 1u << kind) != 0;
    }
    bool findsSkyOnArrival() const {
        return HAS_AMBIENT != 0 && DIRECT_LIGHT == gpu::DIRECT_LIGHTS &&
               (samplesLightKind(gpu::LIGHT_ENVIRONMENT) ||
                (samplesLightKind(gpu::LIGHT_AMBIENT) && PORTALS > 0));
    }
    bool sceneHasCoatNormals() const {
        return sceneHas(gpu::CLOSURE_COAT) && sceneHas(gpu::RECIPE_PRINCIPLED) &&
               (sceneHasSlot(gpu::TEXTURE_NORMAL) || sceneHasSlot(gpu::TEXTURE_CLEARCOAT_NORMAL));
    }
    bool mediaDo(uint32_t bits) const {
        return (MEDIA & bits) != 0;
    }
    bool materialsHaveRow(uint32_t row) const {
        return row <= 1 || sceneHas(gpu::closuresWithRow(row)) ||
               (row == gpu::MEDIUM_PHASES_ROW && mediaDo(gpu::MEDIA_MIX));
    }

    uint32_t words(PathScheduler scheduler) const {
        const uint32_t kept =
            scheduler == PathScheduler::Persistent ? KEPT_BETWEEN_DISPATCHES : ALWAYS;
        constexpr uint32_t uint_ = 1, float_ = 1, bool_ = 1, vec2_ = 2, vec3_ = 3, vec4_ = 4,
                           uvec4_ = 4;
        using gpu::LOBE_DIFFUSE_TRANSMISSION;
        using gpu::MEDIA_OVERLAP;
        using gpu::MEDIA_UNDER_SURFACE;
        uint32_t sum = 0;
#define ADD_WORDS(type, member, exists, readers, writers)                                          \
    sum += (exists) && ((readers)&kept) != 0 ? type##_ : 0;
        PATH_FIELDS(ADD_WORDS)
#undef ADD_WORDS
        return sum;
    }
};

} // namespace

uint32_t pathWords(const KernelFeatures& features, PathScheduler scheduler) {
    return FieldConditions(features).words(scheduler);
}

// --- The kernel ----------------------------------------------------------------------------------

namespace {

using vulkan::BufferUse;

std::vector<vulkan::Binding> kernelBindings(bool texelFetch, bool isStage) {
    std::vector<vulkan::Binding> bindings;
    for (uint32_t i = 0; i < BINDING_COUNT; ++i) {
        if (i == BINDING_QUEUES && !isStage) continue;
        // The film and the work list are read and written row by row as well.
        const bool rows = i < SCENE_BINDING_COUNT || i == BINDING_WORK_ITEMS ||
                          i == BINDING_PIXELS || i == BINDING_FILTER || i == BINDING_GUIDE;
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

// --- What drivers make of it ---------------------------------------------------------------------

std::vector<KernelReport> reportKernels(const vulkan::Device& device, const GpuScene& scene,
                                        const Camera& camera, const Estimator& estimator) {
    struct Kernel {
        const char* name;
        std::optional<uint32_t> stage;
    };
    // Those that begin and stop a render run once.
    const Kernel kernels[] = {{"persistent", std::nullopt},
                              {"depart", gpu::STAGE_DEPART},
                              {"trace", gpu::STAGE_TRACE},
                              {"follow", gpu::STAGE_FOLLOW},
                              {"light", gpu::STAGE_LIGHT}};
    const DeviceTuning tuning = resolve({.texelFetch = false}, device);
    const KernelFeatures features = kernelFeatures(scene, camera, estimator, tuning);
    std::vector<KernelReport> reports;
    for (const Kernel& k : kernels) {
        const PathKernel kernel(device, features, tuning.texelFetch, vulkan::Specialiser::Ours,
                                k.stage);
        reports.push_back({k.name, statisticsOf(device, kernel.pipeline().handle())});
    }
    return reports;
}

} // namespace stromboli
