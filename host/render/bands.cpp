#include "host/render/bands.hpp"

#include "host/film/film.hpp"
#include "host/render/backend.hpp"
#include "host/render/sampling_plan.hpp"

#include <algorithm>

namespace stromboli {

uint64_t hostBytesPerPixel(bool inBlocks) {
    constexpr uint64_t kFilm = sizeof(PixelStatistics);
    // NoiseEstimate: count, mean, squared error; variances of one sample, as sums and relative.
    constexpr uint64_t kEstimate = sizeof(uint32_t) + 4 * sizeof(glm::dvec3) + sizeof(double);
    // The pass, as planned, in the order of work, and as the device's items of 16 bytes.
    constexpr uint64_t kWork = 2 * sizeof(PixelTarget) + 16;
    // Of a share; a render in one go knows nothing of last passes.
    const uint64_t blocks = inBlocks ? kFilm + sizeof(SharedPixel) : 0;
    return kFilm + kEstimate + kWork + NoisePlan::kBytesPerPixel + blocks;
}

std::vector<PictureArea> bandsOf(const PictureArea& area, uint64_t pixels) {
    const Crop all = area.rendered();
    const uint64_t rowsThatFit = std::clamp<uint64_t>(pixels / all.width, 1, all.height);
    return inBands(area, uint32_t((all.height + rowsThatFit - 1) / rowsThatFit));
}

std::vector<PictureArea> inBands(const PictureArea& area, uint32_t count) {
    const Crop all = area.rendered();
    if (count == 1) return {area};
    std::vector<PictureArea> bands;
    for (uint32_t i = 0; i < count; ++i) {
        const auto first = uint32_t(uint64_t(all.height) * i / count);
        const auto end = uint32_t(uint64_t(all.height) * (i + 1) / count);
        bands.push_back({area.width, area.height, {all.x, all.y + first, all.width, end - first}});
    }
    return bands;
}

} // namespace stromboli
