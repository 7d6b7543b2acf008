#pragma once

#include "scene/mitsuba/context.hpp"

namespace stromboli::mitsuba {

/// What an integrator says about the picture becomes hints of the scene.
void readIntegrator(Context& context, const Plugin& integrator);

} // namespace stromboli::mitsuba
