#pragma once

#include "scene/generate/strip_mesh.hpp"

namespace stromboli {

/// Height of a volcano's island above the sea, metres; p in metres from its summit's axis.
double volcanoHeight(const glm::dvec2& p);

/// The island as a height field (z up, metres) of square cells, `cells` to a side; those well
/// under water are left out. Materials: "rock", "ash", "scar", "scrub", "beach".
StripMesh volcanoIsland(uint32_t cells);

} // namespace stromboli
