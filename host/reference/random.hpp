#pragma once

#include <array>
#include <cstdint>

namespace stromboli::reference {

/// Ten rounds of Philox 4x32: Salmon, Moraes, Dror and Shaw, "Parallel Random Numbers: As Easy as
/// 1, 2, 3" (SC 2011). A bijection of the counter for every key.
std::array<uint32_t, 4> philox(std::array<uint32_t, 4> counter, std::array<uint32_t, 2> key);

/// The random numbers of one sample of one pixel: a pure function of (pixel, sample, seed), so
/// that neither threads nor passes change a picture. Streams never overlap, because their Philox
/// counters are distinct.
class RandomStream {
  public:
    RandomStream(uint32_t pixel, uint32_t sample, uint32_t seed);
    /// Uniform in [0, 1): a multiple of 2^-53.
    double next();

  private:
    std::array<uint32_t, 2> key_;
    std::array<uint32_t, 4> counter_; ///< number of the next block, sample, pixel, 0
    std::array<uint32_t, 4> words_{};
    unsigned used_ = 4; ///< words of words_ that have been handed out
};

} // namespace stromboli::reference
