#pragma once

#include "host/kernel/rows.hpp"
#include "shaders/shared/light_types.h"

#include <cstdint>
#include <vector>

namespace stromboli {

struct GpuScene;

/// Where bounces aim: parts of triangles that the light of lamps lands on, most of them the insides
/// of shades and housings (shaders/include/aimed_bounces.glsl). Each triangle's are 2 * 4^level
/// cells, one after the other; gpu::LitCell says how they are numbered.
struct LitCells {
    std::vector<gpu::LitCell> cells; ///< columns of an alias table
    std::vector<uint32_t> ofPlace;   ///< by place in the tree, a whole number of rows; or NO_CELLS

    size_t rowCount() const { return cells.size() + ofPlace.size() / 4; } ///< of litRows()
};

/// The cells that the light of lamps lands on first, with probabilities in proportion to that
/// light. Empty where there is light other than that of lamps that rays can meet, or a gap behind
/// the only one, or where less than half of the light lands in small places from which it goes on
/// to the rest; beside instances, media and mixtures of materials, too. Found by tracing light,
/// by the same rays in every render. They put no bias on a picture, whatever they are, so that they
/// need not be exact.
LitCells findLitCells(const GpuScene& scene);

/// As the kernel reads them: the cells, then the numbers by place.
std::vector<Row> litRows(const LitCells& lit);

} // namespace stromboli
