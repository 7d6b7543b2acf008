#pragma once

#include "scene/mitsuba/context.hpp"

namespace stromboli::mitsuba {

/// Places an emitter of the scene that belongs to no shape. Of several that are all around, the one
/// that the context names is placed.
void placeEmitter(Context& context, const Plugin& emitter);

} // namespace stromboli::mitsuba
