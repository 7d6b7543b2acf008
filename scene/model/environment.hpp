#pragma once

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

namespace stromboli {

/// Light from infinity, seen by the camera too, of a radiance that depends on the direction: an
/// equirectangular picture around the scene. Its upper edge is the direction +y, its middle column
/// -z, its left and right edges +z, and +x lies at three quarters of its width. Between the middles
/// of texels it is interpolated; above those of the first row and below those of the last it does
/// not change. Where rows reach the poles, the middles of the first row are +y and those of the
/// last one -y.
struct Environment {
    std::string name; ///< for messages
    uint32_t width = 1, height = 1;
    std::vector<glm::vec3> radiance{glm::vec3(0)}; ///< row after row, from the top; not negative
    float strength = 1;                            ///< multiplies the radiance
    float rotation = 0;          ///< radians, about +y, counter-clockwise seen from above
    bool rowsReachPoles = false; ///< as Mitsuba 3 has it; height >= 2

    /// Rows from +y to -y, and how far below the picture's upper edge +y is, in rows.
    double rowSpan() const { return rowsReachPoles ? height - 1.0 : height; }
    double poleRow() const { return rowsReachPoles ? 0.5 : 0.0; }
    /// The polar angle of a place in the picture, in rows from its upper edge; radians.
    double polarAt(double place) const {
        return std::clamp(std::numbers::pi * (place - poleRow()) / rowSpan(), 0.0,
                          std::numbers::pi);
    }
    /// The mean sine of the polar angle in a row of texels, and how much of a row it is: of a row
    /// at a pole there is a half.
    double sineOfRow(uint32_t row) const {
        return isPole(row) ? std::sin(0.25 * std::numbers::pi / rowSpan())
                           : std::sin(polarAt(row + 0.5));
    }
    double partOfRow(uint32_t row) const { return isPole(row) ? 0.5 : 1; }
    bool isPole(uint32_t row) const { return rowsReachPoles && (row == 0 || row + 1 == height); }

    bool isConstant() const { return radiance.size() == 1; }
};

} // namespace stromboli
