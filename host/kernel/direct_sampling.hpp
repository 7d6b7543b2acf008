#pragma once

#include "host/kernel/light_table.hpp"
#include "host/render/estimator.hpp"

#include <cstdint>

namespace stromboli {

/// How many samples find direct light at a shading point.
struct DirectSampling {
    uint32_t hemisphere = 0; ///< directions that are traced to whatever they meet
    uint32_t lights = 0;     ///< samples of lights, of all together
    uint32_t perLight =
        1; ///< of those, for one light where each is sampled in turn; else all of them
};

/// Throws std::invalid_argument if the lights were selected for a mode of direct light in which all
/// of them are sampled, and this one leaves some to rays, which would count them twice; or the
/// other way round.
DirectSampling directSampling(const LightTable& lights, const Estimator& settings);

} // namespace stromboli
