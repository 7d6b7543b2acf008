#pragma once

#include "host/render/settings.hpp"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>

namespace stromboli::reference {

/// Ten rounds of Philox 4x32: Salmon, Moraes, Dror and Shaw, "Parallel Random Numbers: As Easy as
/// 1, 2, 3" (SC 2011). A bijection of the counter for every key.
std::array<uint32_t, 4> philox(std::array<uint32_t, 4> counter, std::array<uint32_t, 2> key);

/// The random numbers of one sample of one pixel: a pure function of (pixel, sample, seed), so
/// that neither threads nor passes change a picture. They come in blocks of four. Blocks never
/// overlap, because their Philox counters are distinct; with Sampler::Sobol, a block's numbers over
/// the samples of a pixel are a sequence that fills the unit cube evenly (docs/estimator.md), and
/// different blocks are independent.
class RandomStream {
  public:
    RandomStream(uint32_t pixel, uint32_t sample, uint32_t seed,
                 Sampler sampler = Sampler::Independent);
    /// Uniform in [0, 1): a multiple of 2^-53.
    double next();
    /// Takes the next numbers from the beginning of a block: to be called before numbers that
    /// belong together, so that they are even together.
    void beginBlock();
    /// The first three numbers of the next block.
    glm::dvec3 threeNumbers();
    /// What the sample draws from here on in one of its branches: `count` times as many as there
    /// are samples, spread evenly together, in blocks that no unsplit path takes.
    RandomStream branch(uint32_t number, uint32_t count) const;

    /// Independent numbers of the same sample, from blocks that neither this stream nor a branch
    /// of it takes: for what is not always asked, so that no other number depends on it.
    RandomStream apart() const;

  private:
    void fill();

    uint32_t pixel_, sample_, seed_;
    Sampler sampler_;
    uint32_t block_ = 0;
    std::array<double, 4> numbers_{};
    unsigned used_ = 4; ///< numbers of numbers_ that have been handed out
};

} // namespace stromboli::reference
