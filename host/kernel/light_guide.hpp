#pragma once

#include "host/kernel/rows.hpp"
#include "host/kernel/sampling_tables.hpp"
#include "shaders/shared/guide_types.h"

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

namespace stromboli {

/// By what light samples choose tiles of the environment, for points in each of many cells
/// (docs/theory/estimator.md, "Learned light samples"): as the kernel reads it.
struct LightGuide {
    /// The tree of cells, then a table of tiles for each (shaders/shared/guide_types.h). Every tile
    /// from which light may come has a probability of at least kUnlearned times that by weight.
    /// Empty where there are too few notes.
    std::vector<Row> rows;
    /// How often the second moment of a light sample, by weight alone, is that of a learned one:
    /// told by notes that were not learnt from. 1 where there are too few.
    double gain = 1;

    /// The share of light samples that choose their tile by weight alone.
    static constexpr double kUnlearned = 0.15;
    /// With fewer notes nothing is learnt.
    static constexpr size_t kLeastNotes = 4096;
};

/// Light samples are noted of a picture like the one that is rendered, of at most so many pixels.
inline constexpr uint64_t kNotedPixels = 1u << 15;

/// Samples of each pixel of that picture: two, and up to four of small ones, for as many paths.
constexpr uint32_t notedSamples(uint64_t pixels) {
    return uint32_t(std::clamp<uint64_t>(kNotedPixels / std::max<uint64_t>(pixels, 1), 2, 4));
}

/// A bound of the paths that are noted for a picture of so many pixels.
constexpr uint64_t mostNotedPaths(uint64_t pixels) {
    const uint64_t noted = std::min(pixels, kNotedPixels);
    return std::max(2 * noted, std::min(4 * noted, kNotedPixels));
}

/// The rows of a guide. nodes: GUIDE_NODES, in their order; probabilities: for each of GUIDE_CELLS
/// cells that of each tile, positive wherever that by weight is.
std::vector<Row> guideRows(std::span<const gpu::GuideNode> nodes,
                           std::span<const std::vector<double>> probabilities,
                           const EnvironmentTable& environment);

/// Notes that are all 0 are of no light sample. The result does not depend on the number of
/// threads.
LightGuide learnLightGuide(std::span<const gpu::LightNote> notes,
                           const EnvironmentTable& environment);

} // namespace stromboli
