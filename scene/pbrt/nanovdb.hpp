#pragma once

#include "scene/model/medium_grid.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace stromboli::pbrt {

/// A grid of a NanoVDB file with a value for each cell of the box that its values fill.
struct NanoGrid {
    DensityGrid grid; ///< its toUnit leads from the file's own space
    /// Voxels on a side that one cell is the mean of; 1 where memory allows.
    uint32_t voxelsOfCell = 1;
};

/// The grid of that name; empty: the file has none. bytes: all of the file (.nvdb, format 32 of
/// NanoVDB, Museth 2021, and no other). Floats are understood, as they are or packed by zlib.
/// Negative values and what is no number count as 0. Around the box lies a layer of zeros, so that
/// values fall to it as they do in the file, whose background has to be 0. Throws SceneError with
/// what was found of another kind, and for damaged files. mostCells: of the box, at least 1.
std::optional<NanoGrid> readNanoGrid(std::string_view bytes, const std::string& file,
                                     std::string_view name, uint64_t mostCells);

} // namespace stromboli::pbrt
