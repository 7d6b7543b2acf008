#pragma once

#include "host/bvh/wide_layout.hpp"
#include "host/kernel/feelers.hpp"
#include "scene/camera/camera.hpp"
#include "scene/model/portal.hpp"
#include "shaders/shared/render_types.h"

#include <glm/glm.hpp>

#include <array>
#include <span>
#include <vector>

namespace stromboli {

/// Where light samples to the sky aim. The cross product of a portal's edges points into the room:
/// to the side whose surfaces it is for.
struct Portals {
    std::vector<Portal> all; ///< at most kMostPortals
    double share = 0;        ///< of light samples to the sky that aim at them; in [0, 1)
};

/// The openings through which what the camera sees, and what is seen from there, sees the sky:
/// rectangles in the planes of walls or in recesses behind them. Empty where that would gain
/// little: where the scene lies open, where nothing sees the sky, where the openings are many and
/// small, or where the sky's light comes from less of it than they show. Found by rays
/// (feelers.hpp), the same ones in every render. Portals put no bias on a picture, whatever they
/// are, so that they need not be exact. unevenness: of the sky, as EnvironmentTable has it.
/// seesThrough: the panes of windows, where light samples go through them.
Portals findPortals(const WideLayout& bvh, const Camera& camera, double unevenness,
                    const SeesThrough& seesThrough = {});

/// Portals that were stated: as many as are used, turned to the side that the camera is on.
Portals statedPortals(std::span<const Portal> portals, const Camera& camera);

/// As the kernel reads them (Frame::portals).
std::array<glm::vec4, gpu::PORTAL_ROWS * gpu::MOST_PORTALS>
portalRows(std::span<const Portal> portals);

} // namespace stromboli
