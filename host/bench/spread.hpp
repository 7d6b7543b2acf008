#pragma once

#include <vector>

namespace stromboli::bench {

/// Repeated measurements of one quantity, in its unit: their median and how far they lie apart.
struct Spread {
    double median = 0;
    double least = 0, most = 0;
    double lowerQuartile = 0, upperQuartile = 0;
};

/// Quantiles by linear interpolation between order statistics (Hyndman and Fan 1996, type 7).
/// All 0 for no values.
Spread spreadOf(std::vector<double> values);

} // namespace stromboli::bench
