#pragma once

#include "scene/build/mesh.hpp"

#include <cstdint>
#include <span>
#include <string_view>
#include <unordered_map>
#include <vector>

namespace stromboli::obj {

/// Normals of faces that state none and belong to a smoothing group (`s`): around a vertex, faces
/// of one group share one, the mean of their own normals by the angles of their corners. Between
/// groups there is a crease.
class Smoothing {
  public:
    /// `off`, 0, or the number of a group; anything else is a group of its name.
    void enter(std::string_view group);
    bool isOn() const { return group_ != 0; }

    /// Gives the corners of a polygon numbers of `normals`, from `first` on, and adds to those.
    void apply(std::span<build::Corner> polygon, const std::vector<glm::dvec3>& positions,
               uint32_t first, std::vector<glm::dvec3>& normals);

  private:
    uint32_t group_ = 0;                             ///< 0: none
    std::unordered_map<uint64_t, uint32_t> normals_; ///< by group and position
};

} // namespace stromboli::obj
