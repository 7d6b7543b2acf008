#pragma once

#include <cstdint>

namespace stromboli {

/// Chooses how long a dispatch runs: as a number of kernel loop iterations after which no lane
/// starts another ray. Learns from the time dispatches took, so that they stay near the target:
/// long enough to cost little, short enough for watchdogs and Ctrl-C.
class DispatchPace {
  public:
    /// limit: the most iterations a dispatch may ever be given.
    DispatchPace(double targetSeconds, uint32_t limit);
    uint32_t iterations() const { return iterations_; }
    void took(double seconds);

  private:
    double target_;
    uint32_t limit_;
    uint32_t iterations_;
};

} // namespace stromboli
