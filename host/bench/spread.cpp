#include "host/bench/spread.hpp"

#include <algorithm>
#include <cmath>

namespace stromboli::bench {
namespace {

double quantile(const std::vector<double>& sorted, double fraction) {
    const double at = fraction * double(sorted.size() - 1);
    const auto below = size_t(std::floor(at));
    const size_t above = std::min(below + 1, sorted.size() - 1);
    return std::lerp(sorted[below], sorted[above], at - double(below));
}

} // namespace

Spread spreadOf(std::vector<double> values) {
    if (values.empty()) return {};
    std::sort(values.begin(), values.end());
    return {quantile(values, 0.5), values.front(), values.back(), quantile(values, 0.25),
            quantile(values, 0.75)};
}

} // namespace stromboli::bench
