#pragma once

#include "host/kernel/light_bounds.hpp"
#include "shaders/shared/light_types.h"

#include <array>
#include <span>
#include <vector>

namespace stromboli {

/// Binary trees over lights with what bounds their light: a sphere, a cone of normals and the power
/// (Conty Estevez and Kulla 2018). One tree for each group; a leaf is one light. All levels are
/// full but the deepest, so that nodes need no links (gpu::LightNode).
struct LightTree {
    std::vector<gpu::LightNode> nodes; ///< 2 * lights of each group, group by group
    std::vector<uint32_t> order;       ///< by the light's number: its index in what was given
    std::vector<uint32_t> trails;      ///< by the light's number: LightEntry::trail
    std::array<uint32_t, gpu::LIGHT_GROUP_COUNT> lightsInGroup{};
    uint32_t levels = 0; ///< steps from a root to the deepest leaf
    uint32_t groups = 0; ///< bit n: group n has lights
};

/// Numbers the lights anew. Splits where the layout asks for it, at the median or near it, along
/// the axis where power x area x orientation of the parts is least.
LightTree buildLightTree(std::span<const LightBounds> lights);

} // namespace stromboli
