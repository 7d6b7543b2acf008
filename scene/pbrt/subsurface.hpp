#pragma once

#include "scene/pbrt/surface_maker.hpp"

namespace stromboli::pbrt {

/// What scatters light under its surface becomes a diffuse base of the same colour under an
/// interface. Both versions have the same parameters, but for names.
Surface subsurface(const SurfaceMaker& maker);

/// Hair becomes a rough surface of its colour.
Surface hair(const SurfaceMaker& maker);

} // namespace stromboli::pbrt
