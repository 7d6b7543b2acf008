#pragma once

#include "host/kernel/rows.hpp"
#include "scene/model/light_foci.hpp"
#include "scene/model/material.hpp"
#include "scene/model/medium.hpp"

#include <cstdint>
#include <span>
#include <vector>

namespace stromboli {

/// The media of a scene among the rows of its materials (shaders/shared/medium_types.h).
struct MediumRows {
    std::vector<uint32_t> firstRow; ///< by medium of the scene
    uint32_t kinds = 0;             ///< MEDIA_ bits
    std::vector<uint32_t> closures; ///< closure bits of those that scatter
};

/// Appends the media. hasDetails: materials have rows from gpu::MATERIAL_DETAIL_ROW on.
MediumRows appendMedia(std::vector<Row>& rows, std::span<const Medium> media, bool hasDetails);

/// Says in the rows in front of the materials' headers what is on both sides of their surfaces.
/// materialRow: the first row of each.
void nameBorders(std::vector<Row>& rows, std::span<const Material> materials,
                 std::span<const uint32_t> materialRow, std::span<const uint32_t> mediumRow);

/// Appends the lamps about which distances are drawn, and names them in the media that these are
/// for: the same everywhere, not under surfaces. mediumRow: the first row of each.
void appendFoci(std::vector<Row>& rows, std::span<const Medium> media,
                std::span<const uint32_t> mediumRow, const LightFoci& foci);

/// Upper bounds of a grid's interpolated density in equal blocks of the unit cube, x changing
/// fastest.
struct DensityBounds {
    glm::uvec3 blocks{1};
    std::vector<float> most;
};
DensityBounds boundDensity(const DensityGrid& grid);

} // namespace stromboli
