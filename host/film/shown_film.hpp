#pragma once

#include "host/film/film.hpp"
#include "host/film/image_file.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

namespace stromboli {

/// How a picture comes out on a scale that ends at black and at white.
struct Brightness {
    bool unlit = false;    ///< no pixel has any radiance
    double darkShare = 0;  ///< of the pixels that are shown as black
    double whiteShare = 0; ///< of the pixels in which a channel is above white
    /// Brings the pixel that is brighter than 95 of 100 lit ones to white, in powers of two;
    /// of a lit picture.
    std::optional<double> exposure;
};

Brightness brightnessOf(const Film& film, const ToneCurve& tone);

/// A part of a picture.
struct PartBrightness {
    Brightness brightness;
    uint64_t pixels = 0;
};

/// The brightness of a picture in parts. The exposure is that of the brightest part.
Brightness togetherOf(std::span<const PartBrightness> parts);

/// Gives pixels without samples the mean of one nearby that has some: of the corner of the square
/// of 2, 4, ... `coarsest` pixels (a power of two) in which they lie, where NoisePlan's first
/// passes leave samples. They still count no sample. Pixels of squares without samples stay black.
void showNeighbours(Film& film, uint32_t coarsest);

/// The place in Film::pixels of the pixel whose mean that gives one: itself where it has samples,
/// or where none nearby has.
size_t shownPixel(const Film& film, uint32_t x, uint32_t y, uint32_t coarsest);

/// The number of pixels without samples.
uint64_t unreachedPixels(const Film& film);

/// Shows where the samples went, by q = samples taken / maximum: blue at 0, green at 1/2, red at
/// 1, linear in between, truncated to 8 bits.
ByteImage ratePicture(const Film& film, uint32_t maximum);

/// Where the rate picture of a picture goes: `name.png` -> `name_rate.png`, beside it.
std::filesystem::path ratePicturePath(const std::filesystem::path& picture);

} // namespace stromboli
