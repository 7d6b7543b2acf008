#include "host/kernel/dispatch_pace.hpp"

#include <algorithm>
#include <cmath>

namespace stromboli {

DispatchPace::DispatchPace(double targetSeconds, uint32_t limit)
    : target_(targetSeconds), limit_(limit), iterations_(std::min(64u, limit)) {}

void DispatchPace::took(double seconds) {
    // At most fourfold a step: a first dispatch that includes compilation, or a last one with few
    // lanes, says little about the next.
    const double factor = std::clamp(target_ / std::max(seconds, 1e-9), 0.25, 4.0); // 1 ns
    const double next = std::clamp(std::round(iterations_ * factor), std::min(16.0, double(limit_)),
                                   double(limit_));
    iterations_ = uint32_t(next);
}

} // namespace stromboli
