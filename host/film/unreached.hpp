#pragma once

#include "host/film/film.hpp"

#include <cstdint>

namespace stromboli {

/// Gives pixels without samples the mean of one nearby that has some: of the corner of the square
/// of 2, 4, ... `coarsest` pixels (a power of two) in which they lie, where NoisePlan's first
/// passes leave samples. They still count no sample. Pixels of squares without samples stay black.
void showNeighbours(Film& film, uint32_t coarsest);

/// The place in Film::pixels of the pixel whose mean that gives one: itself where it has samples,
/// or where none nearby has.
size_t shownPixel(const Film& film, uint32_t x, uint32_t y, uint32_t coarsest);

/// The number of pixels without samples.
uint64_t unreachedPixels(const Film& film);

} // namespace stromboli
