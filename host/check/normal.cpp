#include "host/check/normal.hpp"

#include <cmath>
#include <numbers>

namespace stromboli {

double twoSidedProbability(double z) {
    return std::erfc(std::abs(z) / std::numbers::sqrt2);
}

double twoSidedQuantile(double probability) {
    // erfc of 40 / sqrt(2) is 0 in double; halving 64 times leaves less than one rounding.
    double low = 0, high = 40;
    for (int i = 0; i < 64; ++i) {
        const double middle = 0.5 * (low + high);
        (twoSidedProbability(middle) > probability ? low : high) = middle;
    }
    return high;
}

double sidakLevel(double familyError, uint64_t tests) {
    return -std::expm1(std::log1p(-familyError) / double(tests));
}

} // namespace stromboli
