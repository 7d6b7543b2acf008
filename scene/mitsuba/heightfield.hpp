#pragma once

#include "scene/build/mesh.hpp"
#include "scene/mitsuba/context.hpp"

namespace stromboli::mitsuba {

/// The heights of a picture over [-1, 1]^2: a corner for each texel, the first row at y = -1.
build::Mesh heightfieldMesh(const Context& context, const Plugin& shape);

} // namespace stromboli::mitsuba
