#pragma once

#include "scene/model/scene.hpp"

namespace stromboli {

// What light does not pass, for certain, whatever rounding makes of a ray
// (docs/theory/estimator.md, "Occluders").

/// The sine of the smallest angle at which a ray surely meets a surface.
inline constexpr double kLeastFall = 0x1p-5;

/// How far before a plane a ray begins at least, and how far behind it ends, to meet what lies in
/// it: 2^-17 of the scene's largest coordinate, by which positions are rounded.
double certainThickness(const Scene& scene);

/// Lets no light through.
bool isOpaque(const Material& material);

} // namespace stromboli
