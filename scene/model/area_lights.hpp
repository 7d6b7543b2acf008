#pragma once

#include "scene/model/scene.hpp"

namespace stromboli {

/// Makes every rectangular area light emissive geometry, so that camera rays, bounces and light
/// samples all meet the same emitter:
/// - Where an emissive mesh stands for the light (coplanar with it, overlapping it, the usual
///   pair in CGL files), the mesh is the emitter, with its own radiance and shape, and the
///   light is removed: the light is counted once.
/// - Otherwise two triangles are added that emit on the side the light's normal points to.
/// Each decision is a line in scene.report.warnings or .ignored. Not used by conventions
/// where area lights stay lights (AreaLights::StayLights): the rectangle is sampled, the mesh seen.
void resolveAreaLights(Scene& scene);

} // namespace stromboli
