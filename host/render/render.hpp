#pragma once

#include "host/film/film.hpp"
#include "host/render/backend.hpp"
#include "host/render/settings.hpp"

#include <functional>
#include <vector>

namespace stromboli {

/// State of a render for a progress display.
struct RenderProgress {
    uint64_t samplesDone = 0;
    uint64_t samplesAtMost = 0; ///< adaptive renders need fewer
    RenderCounters counters;
    double share = 0; ///< of the work that is done, by samples or, if less is allowed, by time
};

/// How a render ended.
struct RenderOutcome {
    double noise = 0;       ///< square root of the estimated relMSE (noise_estimate.hpp)
    bool outOfTime = false; ///< StopRule::seconds ended it
};

/// Returns false to stop the render early.
using ProgressCallback = std::function<bool(const RenderProgress&)>;

/// Pixels of the crop, row by row, as indices in the whole picture.
std::vector<uint32_t> cropPixels(const RenderSettings& settings);

/// The most samples a render of these settings takes.
uint64_t samplesAtMost(const RenderSettings& settings);

/// Takes all samples of a picture: pass by pass until the sampling plan is content. The film has
/// the whole picture's size; pixels outside the crop have no samples.
Film render(Backend& backend, const RenderSettings& settings, const ProgressCallback& progress = {},
            RenderOutcome* outcome = nullptr);

} // namespace stromboli
