#pragma once

#include "scene/mitsuba/media.hpp"

namespace stromboli::mitsuba {

/// Places a camera, which may be in one of the media. The first one's film gives the picture's size
/// and filter.
void placeSensor(Context& context, Media& media, const Plugin& sensor, bool isFirst);

/// The tangent of half the angle of view across a picture of that aspect, by fov or focal_length.
double halfWidthOf(const Plugin& sensor, double aspect);

} // namespace stromboli::mitsuba
