#pragma once

#include "host/film/shared_pixel.hpp"

#include <cstddef>
#include <optional>
#include <span>
#include <vector>

namespace stromboli {

/// A run of a film's pixels as bytes: the kinds of numbers that follow, which are those that are
/// not 0 everywhere, then they, kind by kind, compressed.
std::vector<std::byte> toBytes(std::span<const SharedPixel> run);

/// A run of pixels as their bytes have them, number by number: a tenth of what the pixels take.
class PackedRun {
  public:
    /// Of pixels without samples.
    explicit PackedRun(size_t pixels) : pixels_(pixels) {}
    /// Nothing if the bytes are others.
    static std::optional<PackedRun> fromBytes(std::span<const std::byte> bytes, size_t pixels);

    size_t size() const { return pixels_; }
    /// Adds the pixels from number `first` on to as many sums.
    void addTo(std::span<SharedPixel> sums, size_t first) const;

  private:
    size_t pixels_;
    uint64_t kinds_ = 0; ///< of numbers, those that are not 0 everywhere
    std::vector<std::byte> numbers_;
};

} // namespace stromboli
