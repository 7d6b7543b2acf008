#include "host/render/render.hpp"

#include <algorithm>

namespace stromboli {

uint64_t samplesAtMost(const PictureArea& area, const Budget& budget) {
    const uint32_t mean = budget.meanSamplesPerPixel, most = budget.mostSamplesPerPixel;
    return area.pixelCount() * (mean > 0 ? std::min(mean, most) : most);
}

Film render(Backend& backend, const RenderSettings& settings, const ProgressCallback& progress,
            RenderOutcome* outcome) {
    SamplingSession session(backend, settings);
    while (session.pass(progress)) {
    }
    if (outcome) *outcome = session.outcome();
    return std::move(session).takeFilm();
}

} // namespace stromboli
