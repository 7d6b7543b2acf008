#include "host/film/unreached.hpp"

#include <algorithm>

namespace stromboli {

size_t shownPixel(const Film& film, uint32_t x, uint32_t y, uint32_t coarsest) {
    const auto placeOf = [&](uint32_t column, uint32_t row) {
        return size_t(row) * film.width + column;
    };
    if (film.at(x, y).taken() > 0) return placeOf(x, y);
    for (uint32_t step = 2; step <= coarsest; step *= 2)
        if (film.at(x - x % step, y - y % step).taken() > 0)
            return placeOf(x - x % step, y - y % step);
    return placeOf(x, y);
}

void showNeighbours(Film& film, uint32_t coarsest) {
    for (uint32_t y = 0; y < film.height; ++y)
        for (uint32_t x = 0; x < film.width; ++x)
            film.at(x, y).mean = film.pixels[shownPixel(film, x, y, coarsest)].mean;
}

uint64_t unreachedPixels(const Film& film) {
    return uint64_t(std::ranges::count(film.pixels, 0u, &PixelStatistics::taken));
}

} // namespace stromboli
