#pragma once

#include "host/render/settings.hpp"
#include "scene/model/scene.hpp"

namespace stromboli {

/// How many branches pay in this scene (docs/estimator.md, "Branches"), for `paths` paths a pixel;
/// a divisor of it.
uint32_t branchesThatPay(const Scene& scene, const RenderSettings& settings, uint32_t paths);

/// Makes samples of `branches` paths out of the counts in `settings`, which are of paths so far and
/// are multiples of it.
void splitSamples(RenderSettings& settings, uint32_t branches);

} // namespace stromboli
