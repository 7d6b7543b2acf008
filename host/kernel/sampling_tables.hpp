#pragma once

#include "host/kernel/rows.hpp"
#include "host/render/estimator.hpp"
#include "scene/model/environment.hpp"
#include "shaders/shared/light_types.h"

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace stromboli {

// --- Alias tables --------------------------------------------------------------------------------

/// A column of an alias table: picked uniformly; then its own index below the threshold, else
/// `alias`.
struct AliasColumn {
    double threshold = 1; ///< in [0, 1]
    uint32_t alias = 0;
};

/// Alias table of discrete probabilities in proportion to `weights` (Vose 1991). Weights are
/// finite and not negative, with a positive sum; an index of weight 0 is never picked.
std::vector<AliasColumn> buildAliasTable(std::span<const double> weights);

// --- Environments --------------------------------------------------------------------------------

/// An environment in the arrays that the kernel reads.
struct EnvironmentTable {
    /// TileColumns rows, then EnvironmentTexel rows; null: the picture is black. Those of an
    /// environment that is turned are the same.
    std::shared_ptr<const RowPages> texels;
    std::vector<double> tileProbability; ///< of a light sample to go to each tile, by weight
    gpu::EnvironmentLight light{};
    SkyRows rows;
    double luminance = 0; ///< integral over all directions, of the radiance times the strength
    /// The mean over all directions of the squared luminance, over the squared mean: 1 for a sky
    /// that is alike everywhere.
    double unevenness = 1;
};

EnvironmentTable packEnvironment(const Environment& environment);
/// The table of the same environment with another rotation (radians).
EnvironmentTable turned(EnvironmentTable table, float rotation);

/// By what the kernel picks a tile of an environment.
struct TileTable {
    std::vector<Row> rows;             ///< ENVIRONMENT_COLUMN_ROWS of TileColumns
    std::vector<double> probabilities; ///< with which it picks each, but for its random numbers
};
TileTable tileTable(std::span<const double> probabilities);
/// The tile that lies in a direction (unit).
uint32_t tileOf(const EnvironmentTable& table, const glm::vec3& direction);

/// Radiance as an EnvironmentTexel holds it, in `low` and `high`: to 2^-18 of its largest
/// component. Components are finite and not negative; those below 2^-127 may become 0.
void encodeRadiance(const glm::vec3& radiance, gpu::EnvironmentTexel& texel);
/// The radiance that the kernel reads.
glm::vec3 decodeRadiance(const gpu::EnvironmentTexel& texel);

// --- Pixel filters -------------------------------------------------------------------------------

/// A pixel filter that is negative in places, along columns or rows, as the kernel samples it:
/// FILTER_CELLS stretches that hold the same integral of its absolute value, in each of which the
/// kernel takes the filter for constant. Those where it is positive come first, both kinds from
/// left to right: the sign of a sample then changes once with each of its numbers, and Sobol points
/// balance signs as evenly as they can (docs/theory/estimator.md, "Camera"). Of any picture the
/// expected value is that of the filter to 1 / (2 FILTER_CELLS) of the largest radiance, times the
/// ratio of both integrals: what one stretch weighs. Of other filters, a row for the binding.
std::vector<Row> filterTable(PixelFilter filter, const FilterShape& shape);
/// How many rows filterTable() has for this filter.
uint32_t filterRows(PixelFilter filter);

} // namespace stromboli
