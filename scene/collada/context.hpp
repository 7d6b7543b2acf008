#pragma once

#include "scene/collada/document.hpp"
#include "scene/collada/load_collada.hpp"
#include "scene/collada/report.hpp"
#include "scene/model/scene.hpp"

namespace stromboli::collada {

/// Coordinates beyond 2^60 are left out: below it the traversal's products stay finite in single
/// precision (scene/README.md).
inline constexpr double kLargestCoordinate = 1152921504606846976.0;

/// What every part of the loader reads from and writes to.
struct Context {
    const Document& document;
    const LoadOptions& options;
    Scene& scene;
    Report& report;
};

} // namespace stromboli::collada
