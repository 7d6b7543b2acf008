#pragma once

#include "scene/model/scene.hpp"

namespace stromboli {

/// A room of 2 m, open towards the camera, lit by strings of small emitters throughout: octahedra
/// with radii from 4 to 32 mm, even in the logarithm, all equally bright. `triangles` is a multiple
/// of 8, at least 8. Always the same for the same number.
Scene emittersRoom(uint32_t triangles, const std::string& source);

/// That room lit by point lights instead, at least 1, which fall off with the squared distance
/// and whose intensities are even in the logarithm over a range of a million.
Scene pointsRoom(uint32_t lights, const std::string& source);

} // namespace stromboli
