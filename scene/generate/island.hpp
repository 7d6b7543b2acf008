#pragma once

#include <string>

namespace stromboli {

/// The text of scene/library/island.dae.
std::string islandScene();

} // namespace stromboli
