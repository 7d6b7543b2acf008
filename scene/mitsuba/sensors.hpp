#pragma once

#include "scene/mitsuba/context.hpp"

namespace stromboli::mitsuba {

/// Places a camera. The first one's film gives the picture's size and filter.
void placeSensor(Context& context, const Plugin& sensor, bool isFirst);

} // namespace stromboli::mitsuba
