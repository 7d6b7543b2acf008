#pragma once

#include "host/render/settings.hpp"
#include "scene/model/scene.hpp"

namespace stromboli {

/// How many branches pay in this scene (docs/estimator.md, "Branches"); a divisor of the number of
/// paths a pixel is to have.
uint32_t branchesThatPay(const Scene& scene, const Estimator& estimator, const PathBudget& budget);

} // namespace stromboli
