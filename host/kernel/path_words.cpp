#include "host/kernel/path_words.hpp"

#include "shaders/shared/path_fields.h"
#include "shaders/shared/texture_types.h"

namespace stromboli {
namespace {

/// The features by their names, and what the shaders derive from them: a field exists where an
/// expression of these says so.
struct FieldConditions {
#define NAME_FEATURE(number, type, name, standard, value, all, label, shown, adds) uint32_t name;
    KERNEL_FEATURES(NAME_FEATURE)
#undef NAME_FEATURE

    explicit FieldConditions(const KernelFeatures& f) {
#define SET_FEATURE(number, type, name, standard, value, all, label, shown, adds) name = f[number];
        KERNEL_FEATURES(SET_FEATURE)
#undef SET_FEATURE
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
    bool emissionHasFactors() const {
        return sceneHasSlot(gpu::TEXTURE_EMISSION) || HAS_ALPHA != 0;
    }
    bool sceneHasCoatNormals() const {
        return sceneHas(gpu::CLOSURE_COAT) && sceneHas(gpu::RECIPE_PRINCIPLED) &&
               (sceneHasSlot(gpu::TEXTURE_NORMAL) || sceneHasSlot(gpu::TEXTURE_CLEARCOAT_NORMAL));
    }
    bool materialsHaveRow(uint32_t row) const {
        const bool hasIndices =
            sceneHas(gpu::INTERFACE_IS_CONDUCTOR | gpu::CLOSURE_LAYERS | gpu::GLOSSY_LOBES);
        if (row == 2) return hasIndices || sceneHas(gpu::INTERFACE_IS_DIELECTRIC);
        if (row == 3) return hasIndices;
        if (row <= 5) return sceneHas(gpu::RECIPE_PRINCIPLED | gpu::RECIPE_BURLEY);
        return sceneHas(gpu::RECIPE_PRINCIPLED);
    }

    /// kept: of readers' bits.
    uint32_t words(uint32_t kept) const {
        constexpr uint32_t uint_ = 1, float_ = 1, bool_ = 1, vec2_ = 2, vec3_ = 3, vec4_ = 4,
                           uvec4_ = 4;
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
    const uint32_t kept = scheduler == PathScheduler::Persistent ? AT_PAUSE : ~0u;
    return FieldConditions(features).words(kept);
}

} // namespace stromboli
