#include "host/kernel/alias_table.hpp"

#include <algorithm>
#include <numeric>

namespace stromboli {

std::vector<AliasColumn> buildAliasTable(std::span<const double> weights) {
    const size_t n = weights.size();
    const double sum = std::accumulate(weights.begin(), weights.end(), 0.0);
    std::vector<double> scaled(n);
    std::vector<uint32_t> small, large;
    for (uint32_t i = 0; i < n; ++i) {
        scaled[i] = weights[i] * double(n) / sum;
        (scaled[i] < 1 ? small : large).push_back(i);
    }
    std::vector<AliasColumn> table(n);
    while (!small.empty() && !large.empty()) {
        const uint32_t s = small.back(), l = large.back();
        small.pop_back();
        table[s] = {scaled[s], l};
        scaled[l] -= 1 - scaled[s];
        if (scaled[l] < 1) {
            large.pop_back();
            small.push_back(l);
        }
    }
    // What is left is 1 but for rounding. An index of weight 0 cannot be left here alone: its
    // column was filled while a larger one was at hand.
    for (uint32_t i : small)
        table[i] = {weights[i] > 0 ? 1.0 : 0.0, i};
    for (uint32_t i : large)
        table[i] = {1.0, i};
    const auto heaviest =
        uint32_t(std::max_element(weights.begin(), weights.end()) - weights.begin());
    for (uint32_t i = 0; i < n; ++i)
        if (table[i].threshold == 0 && table[i].alias == i) table[i].alias = heaviest;
    return table;
}

} // namespace stromboli
