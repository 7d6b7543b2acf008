#pragma once

#include "scene/mitsuba/context.hpp"

namespace stromboli::mitsuba {

/// The sky of Hosek and Wilkie with its sun, as a picture around the scene.
void setSunSky(Context& context, const Plugin& emitter);

} // namespace stromboli::mitsuba
