#pragma once

#include "scene/mitsuba/context.hpp"

namespace stromboli::mitsuba {

/// Places a camera. The first one's film gives the picture's size and filter.
void placeSensor(Context& context, const Plugin& sensor, bool isFirst);

/// The tangent of half the angle of view across a picture of that aspect, by fov or focal_length.
double halfWidthOf(const Plugin& sensor, double aspect);

} // namespace stromboli::mitsuba
