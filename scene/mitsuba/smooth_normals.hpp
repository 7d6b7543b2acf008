#pragma once

#include "scene/build/mesh.hpp"

namespace stromboli::mitsuba {

/// Normals as if the mesh stated none, but that edges stay sharp: each corner of a triangle has the
/// mean of those triangles at its position that are turned away from its own by no more than an
/// angle, each weighed by its angle there.
void smoothUpTo(build::Mesh& mesh, double degrees);

} // namespace stromboli::mitsuba
