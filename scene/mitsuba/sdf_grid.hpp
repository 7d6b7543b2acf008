#pragma once

#include "scene/build/mesh.hpp"
#include "scene/mitsuba/context.hpp"

namespace stromboli::mitsuba {

/// The surface of a grid of signed distances, which are less than 0 inside; it fills the unit cube.
/// Throws SceneError where there is none.
build::Mesh sdfGridMesh(const Context& context, const Plugin& shape);

} // namespace stromboli::mitsuba
