#pragma once

#include "host/render/estimator.hpp"

#include <glm/glm.hpp>

namespace stromboli::reference {

/// A place from the pixel's upper left corner, in pixels, as the filter weighs places. u, v:
/// uniform in [0, 1).
glm::dvec2 placeInPixel(PixelFilter filter, double u, double v);

} // namespace stromboli::reference
