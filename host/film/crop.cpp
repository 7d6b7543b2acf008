#include "host/film/crop.hpp"

#include "host/core/error.hpp"

#include <fmt/format.h>

namespace stromboli {

Crop cropInside(const Film& film, const Crop& crop) {
    if (crop.width == 0) return {0, 0, film.width, film.height};
    const bool inside = crop.height > 0 && uint64_t(crop.x) + crop.width <= film.width &&
                        uint64_t(crop.y) + crop.height <= film.height;
    if (!inside)
        throw UsageError(fmt::format("the crop of {} x {} pixels at ({}, {}) is not a part of the "
                                     "picture of {} x {} pixels",
                                     crop.width, crop.height, crop.x, crop.y, film.width,
                                     film.height));
    return crop;
}

} // namespace stromboli
