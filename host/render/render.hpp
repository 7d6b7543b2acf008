#pragma once

#include "host/film/film.hpp"
#include "host/render/backend.hpp"
#include "host/render/sampling_session.hpp"
#include "host/render/settings.hpp"

namespace stromboli {

/// The most samples a render of this budget takes.
uint64_t samplesAtMost(const PictureArea& area, const Budget& budget);

/// Takes all samples of a picture, in a session of its own: pass by pass until the sampling plan is
/// content.
Film render(Backend& backend, const RenderSettings& settings, const ProgressCallback& progress = {},
            RenderOutcome* outcome = nullptr);

} // namespace stromboli
