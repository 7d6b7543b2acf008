#include "host/film/brightness.hpp"

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

} // namespace stromboli
