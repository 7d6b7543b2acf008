#pragma once

#include "host/film/film.hpp"

#include <cstdint>
#include <random>

namespace stromboli {

/// Three samples a pixel, some brighter than white.
inline Film randomFilm(uint32_t width, uint32_t height) {
    std::mt19937_64 random(3);
    std::exponential_distribution<double> radiance(2);
    Film film(width, height);
    for (PixelStatistics& pixel : film.pixels)
        for (int i = 0; i < 3; ++i)
            pixel.add({radiance(random), radiance(random), radiance(random)});
    return film;
}

} // namespace stromboli
