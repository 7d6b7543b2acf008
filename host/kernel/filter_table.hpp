#pragma once

#include "host/kernel/rows.hpp"
#include "host/render/estimator.hpp"

#include <vector>

namespace stromboli {

/// A pixel filter that is negative in places, along columns or rows, as the kernel samples it:
/// FILTER_CELLS stretches that hold the same integral of its absolute value, in each of which the
/// kernel takes the filter for constant. Those where it is positive come first, both kinds from
/// left to right: the sign of a sample then changes once with each of its numbers, and Sobol points
/// balance signs as evenly as they can (docs/estimator.md, "Camera"). Of any picture the expected
/// value is that of the filter to 1 / (2 FILTER_CELLS) of the largest radiance, times the ratio of
/// both integrals: what one stretch weighs. Of other filters, a row for the binding.
std::vector<Row> filterTable(PixelFilter filter, const FilterShape& shape);
/// As many rows as it has.
uint32_t filterRows(PixelFilter filter);

} // namespace stromboli
