#include "host/film/rate_picture.hpp"

#include <algorithm>

namespace stromboli {

/// Integers throughout, so that truncation never depends on a rounding.
static void paint(uint8_t* pixel, uint64_t taken, uint64_t maximum) {
    taken = std::min(taken, maximum);
    const auto part = [&](uint64_t halves) { return static_cast<uint8_t>(255 * halves / maximum); };
    const bool lowerHalf = 2 * taken <= maximum;
    pixel[0] = lowerHalf ? uint8_t(0) : part(2 * taken - maximum);
    pixel[1] = lowerHalf ? part(2 * taken) : part(2 * maximum - 2 * taken);
    pixel[2] = lowerHalf ? part(maximum - 2 * taken) : uint8_t(0);
}

ByteImage ratePicture(const Film& film, uint32_t maximum) {
    ByteImage image(film.width, film.height);
    for (uint32_t y = 0; y < film.height; ++y)
        for (uint32_t x = 0; x < film.width; ++x)
            paint(image.pixel(x, y), film.at(x, y).taken(), std::max(maximum, 1u));
    return image;
}

std::filesystem::path ratePicturePath(const std::filesystem::path& picture) {
    return picture.parent_path() / (picture.stem().string() + "_rate.png");
}

} // namespace stromboli
