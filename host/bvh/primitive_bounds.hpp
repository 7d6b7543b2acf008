#pragma once

#include "scene/model/scene.hpp"

#include <cstdint>

namespace stromboli {

/// The box of one primitive of the scene: triangles are 0..nt-1, then spheres nt..nt+ns-1. The
/// primitive lies wholly inside: a triangle's box is exact, a sphere's is rounded outward. NaN
/// where a corner is not finite.
Bounds primitiveBounds(const Scene& scene, uint32_t primitive);

} // namespace stromboli
