#pragma once

#include "host/kernel/rows.hpp"
#include "host/kernel/sampling_tables.hpp"
#include "shaders/shared/guide_types.h"

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

/// Light samples are noted of a picture like the one that is rendered, of at most so many pixels
/// and so many samples of each.
inline constexpr uint64_t kNotedPixels = 1u << 16;
inline constexpr uint32_t kNotedSamples = 4;

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
