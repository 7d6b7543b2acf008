#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace stromboli {

// What of a plane is covered by triangles, and rectangles of that: for find_occluders.cpp.

/// A triangle in the coordinates of a plane that it lies in.
struct FlatTriangle {
    std::array<glm::dvec2, 3> corners{};
};

/// The direction that most of the edges of these triangles have, by length, or are at right angles
/// to: unit. They lie in a plane with this unit normal.
glm::dvec3 usualEdge(const glm::dvec3& normal,
                     std::span<const std::array<glm::dvec3, 3>> triangles);

/// Cells along a side of the grid.
inline constexpr size_t kOpaqueSide = 24;

/// Some columns of some rows of cells.
struct CellRectangle {
    size_t column = 0, row = 0, columns = 0, rows = 0;
    uint32_t count = 0; ///< of what is in these cells

    bool holds(size_t cell) const {
        const size_t x = cell % kOpaqueSide, y = cell / kOpaqueSide;
        return x >= column && x < column + columns && y >= row && y < row + rows;
    }
};

/// A grid over a part of a plane; of each cell whether triangles cover all of it.
class OpaqueCells {
  public:
    OpaqueCells() = default;
    /// Over where most of `wanted` are.
    OpaqueCells(std::span<const FlatTriangle> triangles, std::span<const glm::dvec2> wanted);

    /// Row by row; none: outside, or not covered.
    std::optional<size_t> cellAt(const glm::dvec2& place) const;
    glm::dvec2 cornerOf(size_t column, size_t row) const;
    /// The one of covered cells alone with the largest sum of counts; counts: by cell.
    CellRectangle bestRectangle(std::span<const uint32_t> counts) const;

  private:
    glm::dvec2 lo_{0}, hi_{0};
    std::vector<bool> isCovered_; ///< by cell; empty: none is
};

/// Whether triangles cover all of a rectangle, but for cracks that rounding leaves.
bool isCovered(const glm::dvec2& lo, const glm::dvec2& hi, std::span<const FlatTriangle> triangles);

} // namespace stromboli
