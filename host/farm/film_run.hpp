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

enum class Passes { Several, One };

/// Fills the run in; nothing if the bytes were others. Where each pixel has one pass, nothing is
/// said of it beside its number.
std::optional<Passes> fromBytes(std::span<const std::byte> bytes, std::vector<SharedPixel>& run);

} // namespace stromboli
