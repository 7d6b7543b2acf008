#pragma once

#include "scene/model/scene.hpp"

#include <vector>

namespace stromboli {

/// The box of every primitive of the scene: triangles 0..nt-1, then spheres nt..nt+ns-1. The
/// primitive lies wholly inside: a triangle's box is exact, a sphere's is rounded outward.
std::vector<Bounds> primitiveBounds(const Scene& scene);

} // namespace stromboli
