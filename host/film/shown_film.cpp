#include "host/film/shown_film.hpp"

#include <algorithm>
#include <cmath>
#include <vector>

namespace stromboli {

Brightness brightnessOf(const Film& film, const ToneCurve& tone) {
    const double scale = std::exp2(tone.exposure);
    std::vector<double> lit;
    size_t dark = 0, white = 0;
    for (const PixelStatistics& p : film.pixels) {
        const double most = std::max({p.mean.x, p.mean.y, p.mean.z});
        if (most > 0) lit.push_back(most);
        dark += tone.toByte(most) == 0;
        white += most * scale > 1;
    }
    Brightness b;
    b.unlit = lit.empty();
    if (film.pixels.empty()) return b;
    b.darkShare = double(dark) / double(film.pixels.size());
    b.whiteShare = double(white) / double(film.pixels.size());
    if (lit.empty()) return b;
    const auto bright = lit.begin() + std::ptrdiff_t(0.95 * double(lit.size() - 1));
    std::nth_element(lit.begin(), bright, lit.end());
    b.exposure = -std::log2(*bright);
    return b;
}

Brightness togetherOf(std::span<const PartBrightness> parts) {
    Brightness sum;
    sum.unlit = true;
    double pixels = 0;
    for (const auto& [b, count] : parts) {
        sum.unlit = sum.unlit && b.unlit;
        sum.darkShare += b.darkShare * double(count);
        sum.whiteShare += b.whiteShare * double(count);
        if (b.exposure) sum.exposure = std::min(sum.exposure.value_or(*b.exposure), *b.exposure);
        pixels += double(count);
    }
    if (pixels > 0) sum.darkShare /= pixels, sum.whiteShare /= pixels;
    return sum;
}

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
