#pragma once

#include "host/bvh/wide_layout.hpp"
#include "host/kernel/detail_plan.hpp"
#include "host/kernel/rows.hpp"

#include <cstdint>
#include <vector>

namespace stromboli {

/// What beside parameters and normals the kernel reads (shaders/shared/texture_types.h).
struct DetailRows {
    RowPages rows;                             ///< the detail buffer: attributes, then texels
    std::vector<std::vector<Row>> ofLights;    ///< of each of the scene's: its picture's TextureUse
    std::vector<std::vector<Row>> ofMaterials; ///< by material: MaterialDetail and TextureUse rows;
                                               ///< empty where no material has any
    size_t firstTexel = 0;                     ///< into rows
};

DetailRows packDetails(const Scene& scene, const WideLayout& bvh, const DetailPlan& plan);

/// The same of a scene that `before` was packed from but for the places of its objects, by the same
/// plan, which has these attributes (gpu::ATTRIBUTE_ bits): texels are copied.
DetailRows repackAttributes(const Scene& scene, const WideLayout& bvh, uint32_t attributes,
                            const DetailRows& before);

/// Rows that one primitive's attributes take.
uint32_t attributeRows(uint32_t attributes);

} // namespace stromboli
