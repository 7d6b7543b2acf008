#include "host/kernel/kernel_modules.hpp"

#include "embedded/pathtrace_facets_storage.h"
#include "embedded/pathtrace_facets_texel.h"
#include "embedded/pathtrace_one_light_storage.h"
#include "embedded/pathtrace_one_light_texel.h"
#include "embedded/pathtrace_rich_storage.h"
#include "embedded/pathtrace_rich_texel.h"
#include "embedded/pathtrace_rich_usual_storage.h"
#include "embedded/pathtrace_rich_usual_texel.h"
#include "embedded/pathtrace_storage.h"
#include "embedded/pathtrace_texel.h"
#include "embedded/pathtrace_usual_storage.h"
#include "embedded/pathtrace_usual_texel.h"

namespace stromboli {
namespace {

using Code = std::span<const uint32_t>;

/// What USUAL_MODES fixes in shaders/include/specialisation.glsl. Those modules lack PLACEMENTS.
bool hasUsualModes(const KernelFeatures& f) {
    return f[SPEC_LARGE_TREE] == 0 && f[SPEC_HAS_PLACEMENTS] == 0 &&
           f[SPEC_INTEGRATOR] == gpu::INTEGRATOR_PATH &&
           f[SPEC_DIRECT_LIGHT] == gpu::DIRECT_LIGHTS && f[SPEC_CS184] == 0 &&
           f[SPEC_COUNT_STEPS] == 0;
}

/// What ONE_LIGHT fixes there.
bool hasOneLight(const KernelFeatures& f) {
    return f[SPEC_LIGHT_CHOICE] == gpu::LIGHT_CHOICE_ONE;
}

/// What modules without FACET_MATERIALS lack.
bool hasFacetMaterials(const KernelFeatures& f) {
    return f[SPEC_BSDF_KINDS] >> gpu::BSDF_CONDUCTOR != 0 || f[SPEC_FACETS] != 0;
}

} // namespace

bool needsRichModule(const KernelFeatures& f) {
    return hasFacetMaterials(f) || (f[SPEC_LIGHT_KINDS] & 1u << gpu::LIGHT_PROJECTOR) != 0 ||
           f[SPEC_HAS_ENVIRONMENT] != 0 || f[SPEC_HAS_BACKDROP] != 0 || f[SPEC_HAS_LENS] != 0 ||
           f[SPEC_PIXEL_FILTER] != gpu::FILTER_BOX || f[SPEC_FILTER_EXTRA] != 0 ||
           f[SPEC_HIDES_SURFACES] != 0 || f[SPEC_FLAT_TERMINATOR] != 0 ||
           (f[SPEC_BSDF_KINDS] & 1u << gpu::BSDF_PRINCIPLED) != 0 || f[SPEC_TEXTURE_SLOTS] != 0 ||
           f[SPEC_LOOSE_SLOTS] != 0 || f[SPEC_LOOSE_TEXTURES] != 0 || f[SPEC_TEXEL_KINDS] != 0 ||
           f[SPEC_ATTRIBUTES] != 0 || f[SPEC_ALPHA] != 0 || f[SPEC_TANGENT_FRAMES] != 0 ||
           f[SPEC_BLENDS] != 0 || f[SPEC_RELIEF_RULES] != 0 || f[SPEC_PRINCIPLED_FEATURES] != 0 ||
           f[SPEC_HAS_PLACEMENTS] != 0 || f[SPEC_WAITING_PART] != 0 ||
           f[SPEC_CORNER_NORMALS] != f[SPEC_HAS_NORMALS];
}

std::span<const uint32_t> kernelModule(const KernelFeatures& features, bool texelFetch) {
    if (hasFacetMaterials(features))
        return texelFetch ? Code(pathtrace_facets_texel) : pathtrace_facets_storage;
    if (needsRichModule(features) && hasUsualModes(features))
        return texelFetch ? Code(pathtrace_rich_usual_texel) : pathtrace_rich_usual_storage;
    if (needsRichModule(features))
        return texelFetch ? Code(pathtrace_rich_texel) : pathtrace_rich_storage;
    if (!hasUsualModes(features)) return texelFetch ? Code(pathtrace_texel) : pathtrace_storage;
    if (hasOneLight(features))
        return texelFetch ? Code(pathtrace_one_light_texel) : pathtrace_one_light_storage;
    return texelFetch ? Code(pathtrace_usual_texel) : pathtrace_usual_storage;
}

} // namespace stromboli
