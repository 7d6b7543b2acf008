#include "host/render/render.hpp"

#include <algorithm>

namespace stromboli {

std::vector<uint32_t> cropPixels(const PictureArea& area) {
    const Crop c = area.rendered();
    std::vector<uint32_t> pixels;
    pixels.reserve(area.pixelCount());
    for (uint32_t y = 0; y < c.height; ++y)
        for (uint32_t x = 0; x < c.width; ++x)
            pixels.push_back((c.y + y) * area.width + c.x + x);
    return pixels;
}

uint64_t samplesAtMost(const PictureArea& area, const Budget& budget) {
    const uint32_t mean = budget.meanSamplesPerPixel, most = budget.mostSamplesPerPixel;
    return area.pixelCount() * (mean > 0 ? std::min(mean, most) : most);
}

Film render(Backend& backend, const RenderSettings& settings, const ProgressCallback& progress,
            RenderOutcome* outcome) {
    RenderSession session(backend, settings);
    while (session.pass(progress)) {
    }
    if (outcome) *outcome = session.outcome();
    return std::move(session).takeFilm();
}

} // namespace stromboli
