#pragma once

#include <string>

namespace stromboli {

/// The text of scene/library/cornell_mesh.dae.
std::string cornellMeshScene();

} // namespace stromboli
