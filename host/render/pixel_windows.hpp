#pragma once

#include "host/film/film.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace stromboli {

/// Sums over some pixels: of their means, and of a value that goes with each, per channel.
struct PixelGroup {
    glm::dvec3 value{0.0}, mean{0.0};
    double pixels = 0;

    void operator+=(const PixelGroup& other) {
        value += other.value;
        mean += other.mean;
        pixels += other.pixels;
    }
};

/// Sums over the neighbours of each pixel: the window of 7 x 7 pixels around it, itself left out.
/// Row after row: the rows that a window touches are kept as sums over its width. Nothing is ever
/// subtracted, so that a bright sample leaves no rounding error behind. Pixels of fewer than two
/// samples count for nothing.
class PixelWindows {
  public:
    /// Half the width of the window, less a half. 48 pixels of 4 samples: a relative sigma of 12 %
    /// for normal samples. Neighbours that have more samples for a pixel's sake judge that pixel in
    /// turn, the more so the fewer they are: 2, for all its 8 % less error, darkens
    /// cornell_mirror_glass by 0.15 % (64 samples), 3 by 0.03 %.
    static constexpr int64_t kReach = 3;

    /// values: by pixel of the film. of() is first asked for row `first`.
    PixelWindows(const Film& film, std::span<const glm::dvec3> values, int64_t first);

    /// The groups of each pixel of row y, which must be the row after the last that was asked for.
    std::vector<PixelGroup> of(int64_t y);
    /// The pixel by itself.
    PixelGroup alone(int64_t x, int64_t y) const;

  private:
    std::vector<PixelGroup> besides(int64_t y) const;
    void sumRow(int64_t y);

    const Film& film_;
    std::span<const glm::dvec3> values_;
    std::array<std::vector<PixelGroup>, 2 * kReach + 1> rows_; ///< of y, at y modulo their number
};

} // namespace stromboli
