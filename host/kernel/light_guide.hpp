#pragma once

#include "host/kernel/rows.hpp"
#include "host/kernel/sampling_tables.hpp"
#include "shaders/shared/guide_types.h"

#include <cstdint>
#include <span>
#include <vector>

namespace stromboli {

/// A light sample to the environment, by its weight alone.
struct LightNote {
    glm::vec3 position{0}, normal{0}; ///< of the surface, on the side of the light
    glm::vec3 direction{0};           ///< unit, to the light
    float value = 0;                  ///< what it brings, in any unit; 0: it is shaded
    bool isOfOdd = false; ///< of a place of an odd number: half of them tell what the others teach
};

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

/// The rows of a guide. nodes: GUIDE_NODES, in their order; probabilities: for each of GUIDE_CELLS
/// cells that of each tile, positive wherever that by weight is.
std::vector<Row> guideRows(std::span<const gpu::GuideNode> nodes,
                           std::span<const std::vector<double>> probabilities,
                           const EnvironmentTable& environment);

/// The result does not depend on the number of threads.
LightGuide learnLightGuide(std::span<const LightNote> notes, const EnvironmentTable& environment);

} // namespace stromboli
