#pragma once

#include "host/kernel/light_bounds.hpp"
#include "shaders/shared/light_types.h"

#include <span>
#include <vector>

namespace stromboli {

/// Balanced binary trees over lights with what bounds their light: a sphere, a cone of normals and
/// the power (Conty Estevez and Kulla 2018). One tree for each group; a leaf is one light.
struct LightTree {
    /// The first LIGHT_GROUP_COUNT are the roots of the groups, of power 0 where a group is empty;
    /// siblings are side by side.
    std::vector<gpu::LightNode> nodes;
    std::vector<uint32_t> trails; ///< by light: LightEntry::trail
    uint32_t levels = 0;          ///< steps from a root to the deepest leaf
    uint32_t groups = 0;          ///< bit n: group n has lights
};

/// Leaves name lights by their index in `lights`. Splits at the median, so that all leaves are
/// equally deep but for one level, along the axis where power x area x orientation of the halves is
/// least.
LightTree buildLightTree(std::span<const LightBounds> lights);

} // namespace stromboli
