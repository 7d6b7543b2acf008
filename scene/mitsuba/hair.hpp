#pragma once

#include "scene/build/mesh.hpp"
#include "scene/mitsuba/context.hpp"

namespace stromboli::mitsuba {

/// It is many thin tubes along lines of a file: hair, linearcurve or bsplinecurve.
bool isHair(const Plugin& shape);

/// These tubes, of six sides that look round, and in the mean over all directions as wide as round
/// ones.
build::Mesh hairMesh(const Context& context, const Plugin& shape);

} // namespace stromboli::mitsuba
