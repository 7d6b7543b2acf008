#pragma once

#include "scene/mitsuba/context.hpp"

namespace stromboli::mitsuba {

/// Places an emitter of the scene that belongs to no shape: point, spot, directional, constant or
/// envmap.
void placeEmitter(Context& context, const Plugin& emitter);

} // namespace stromboli::mitsuba
