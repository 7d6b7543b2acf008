#pragma once

#include "scene/model/scene.hpp"
#include "shaders/shared/scene_types.h"

#include <array>
#include <cstdint>
#include <span>

namespace stromboli::bvh {

/// The slot of each of up to 8 children, so that `slot ^ octant` orders them front to back for rays
/// of every octant, as well as can be: children on the high side of axis k go to slots whose bit k
/// is set (Ylitie, Karras and Laine 2017, section 3.2), the assignment with the greatest sum of
/// offsets along the slots' diagonals, weighted by the children's areas. The best one, by dynamic
/// programming over the sets of slots taken.
std::array<uint8_t, gpu::WIDE_CHILDREN> assignSlots(std::span<const Bounds> children);

} // namespace stromboli::bvh
