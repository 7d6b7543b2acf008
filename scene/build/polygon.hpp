#pragma once

#include "scene/build/mesh.hpp"
#include "scene/build/report.hpp"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace stromboli::build {

/// Cuts the polygons of a mesh into triangles; concave ones too.
class PolygonCutter {
  public:
    /// `mesh` and `report` must outlive the cutter.
    PolygonCutter(const Mesh& mesh, Report& report) : mesh_(mesh), report_(report) {}

    /// Appends the polygon's triangles to `part`. Polygons of fewer than three corners are left out
    /// and those that cross themselves are cut somehow, with warnings. Corners are numbers of
    /// positions that the mesh has.
    void add(std::span<const Corner> polygon, MeshPart& part);

  private:
    const Mesh& mesh_;
    Report& report_;
    std::vector<glm::dvec3> points_;              ///< scratch
    std::vector<std::array<uint32_t, 3>> pieces_; ///< scratch
};

} // namespace stromboli::build
