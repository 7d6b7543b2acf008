#include "host/film/unreached.hpp"

#include <algorithm>

namespace stromboli {

void showNeighbours(Film& film, uint32_t coarsest) {
    for (uint32_t y = 0; y < film.height; ++y)
        for (uint32_t x = 0; x < film.width; ++x) {
            PixelStatistics& pixel = film.at(x, y);
            for (uint32_t step = 2; pixel.taken() == 0 && step <= coarsest; step *= 2) {
                const PixelStatistics& corner = film.at(x - x % step, y - y % step);
                if (corner.taken() == 0) continue;
                pixel.mean = corner.mean;
                break;
            }
        }
}

uint64_t unreachedPixels(const Film& film) {
    return uint64_t(std::ranges::count(film.pixels, 0u, &PixelStatistics::taken));
}

} // namespace stromboli
