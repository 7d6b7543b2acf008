#pragma once

#include "host/kernel/rows.hpp"

#include <glm/glm.hpp>

#include <vector>

namespace stromboli {

/// What light from one direction does not reach, for certain: a place below the height of its cell.
/// Rows and columns are in units of a cell, SHADOW_MAP_SIDE of each.
struct ShadowMap {
    glm::vec3 towards{0};          ///< unit, to the light; heights are along it
    glm::vec4 across{0}, along{0}; ///< column and row of a place p: dot(xyz, p) + w
    std::vector<Row> heights;      ///< of the cells, as floats, row by row
};

} // namespace stromboli
