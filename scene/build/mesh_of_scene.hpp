#pragma once

#include "scene/build/mesh.hpp"
#include "scene/model/scene.hpp"

namespace stromboli::build {

/// All triangles of a scene that another loader read, as one part: formats refer to files of
/// meshes.
Mesh meshOfScene(const Scene& scene);

} // namespace stromboli::build
