#pragma once

#include "host/kernel/medium_rows.hpp"
#include "host/kernel/rows.hpp"
#include "scene/model/material.hpp"
#include "shaders/shared/bsdf_types.h"

#include <span>
#include <vector>

namespace stromboli {

// --- Materials -----------------------------------------------------------------------------------

/// The materials of a scene as the kernel reads them (shaders/shared/bsdf_types.h).
struct MaterialRows {
    std::vector<Row> rows;
    std::vector<uint32_t> firstRow; ///< by material of the scene
    /// Materials beside any one of a mixture's that are evaluated with it: of the largest mixture
    /// that details name.
    uint32_t mostOthers = 0;
    MediumRows media;
    uint32_t mostBlends = 0; ///< most times that another material may take a place at one hit
};

/// details: of each material, the rows from gpu::MATERIAL_DETAIL_ROW on; empty: none has any.
/// media: of the scene, whose rows are behind those of its materials.
MaterialRows packMaterials(std::span<const Material> materials,
                           std::span<const std::vector<Row>> details = {},
                           std::span<const Medium> media = {});

/// MATERIAL_RELIEF_ bits.
uint32_t reliefBits(const Material& material);

/// Whether a material refracts light of each colour in its own direction, or has a thin film on it.
bool isDispersive(const Material& material);
bool isIridescent(const Material& material);

/// LOBE_ and closure bits of a material (shaders/shared/parameters.h).
uint32_t closureBits(const Material& material);

/// Which of these bits the materials of a scene have.
struct SceneClosures {
    uint32_t some = 0;                ///< of some material
    uint32_t all = gpu::CLOSURE_MASK; ///< of all that they concern

    /// bits: of one more material.
    void add(uint32_t bits);
};

} // namespace stromboli
