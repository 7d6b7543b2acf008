#pragma once

#include "host/kernel/rows.hpp"
#include "scene/model/material.hpp"
#include "shaders/shared/bsdf_types.h"

#include <span>
#include <vector>

namespace stromboli {

/// The materials of a scene as the kernel reads them (shaders/shared/bsdf_types.h).
struct MaterialRows {
    std::vector<Row> rows;
    std::vector<uint32_t> firstRow; ///< by material of the scene
};

/// details: of each material, the rows from gpu::MATERIAL_DETAIL_ROW on; empty: none has any.
MaterialRows packMaterials(std::span<const Material> materials,
                           std::span<const std::vector<Row>> details = {});

/// MATERIAL_RELIEF_ bits.
uint32_t reliefBits(const Material& material);

/// PRINCIPLED_HAS_ bits of what the material has; 0 for other kinds.
uint32_t principledFeatures(const Material& material);

/// The FACETS_ and BURLEY_HAS_ bits of the microfacets of a conductor, a dielectric or plastic; 0
/// where it has none.
uint32_t facetBits(const Material& material);

/// The BSDF_ kind that stands for a material of the scene.
uint32_t bsdfKind(const Material& material);

} // namespace stromboli
