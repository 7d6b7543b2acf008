#pragma once

#include "tests/shaders/queries.h"

#include <vector>

namespace stromboli::test {

/// Sample correlation of n pairs of uniform numbers, components `i` and `j` of what `a` and `b`
/// were answered; its standard deviation is n^-1/2.
inline double correlation(const std::vector<gpu::RandomAnswer>& a, size_t i,
                          const std::vector<gpu::RandomAnswer>& b, size_t j) {
    double sum = 0;
    for (size_t k = 0; k < a.size(); ++k)
        sum += (a[k].block[i] - 0.5) * (b[k].block[j] - 0.5);
    return 12 * sum / double(a.size());
}

} // namespace stromboli::test
