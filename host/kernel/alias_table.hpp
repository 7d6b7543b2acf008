#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace stromboli {

/// A column of an alias table: picked uniformly; then its own index below the threshold, else
/// `alias`.
struct AliasColumn {
    double threshold = 1; ///< in [0, 1]
    uint32_t alias = 0;
};

/// Alias table of discrete probabilities in proportion to `weights` (Vose 1991). Weights are
/// finite and not negative, with a positive sum; an index of weight 0 is never picked.
std::vector<AliasColumn> buildAliasTable(std::span<const double> weights);

} // namespace stromboli
