#pragma once

#include <glm/glm.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>
#include <vector>

namespace stromboli {

/// How the rows of an equirectangular picture lie between +y and -y. Places are in rows from the
/// picture's upper edge, polar angles in radians from +y.
struct SkyRows {
    uint32_t height = 1;
    /// The middles of the first and the last row are +y and -y (height >= 2), and half of each row
    /// is not there. Otherwise the picture's upper and lower edges are +y and -y.
    bool reachPoles = false;

    double span() const { return reachPoles ? height - 1.0 : height; } ///< from +y to -y
    double pole() const { return reachPoles ? 0.5 : 0.0; }             ///< the place of +y
    double placeAt(double polar) const { return polar / std::numbers::pi * span() + pole(); }
    /// Of a place beyond a pole, that of the pole.
    double polarAt(double place) const {
        return std::clamp(std::numbers::pi * (place - pole()) / span(), 0.0, std::numbers::pi);
    }
    bool isAtPole(uint32_t row) const { return reachPoles && (row == 0 || row + 1 == height); }
    /// How much of a row is there, and the sine of the polar angle in the middle of that.
    double sineOf(uint32_t row) const {
        return isAtPole(row) ? std::sin(0.25 * std::numbers::pi / span())
                             : std::sin(polarAt(row + 0.5));
    }
    double partOf(uint32_t row) const { return isAtPole(row) ? 0.5 : 1; }
};

/// Light from infinity, seen by the camera too, of a radiance that depends on the direction: an
/// equirectangular picture around the scene. Its upper edge is the direction +y, its middle column
/// -z, its left and right edges +z, and +x lies at three quarters of its width. Between the middles
/// of texels it is interpolated; above those of the first row and below those of the last it does
/// not change.
struct Environment {
    std::string name; ///< for messages
    uint32_t width = 1, height = 1;
    std::vector<glm::vec3> radiance{glm::vec3(0)}; ///< row after row, from the top; not negative
    float strength = 1;                            ///< multiplies the radiance
    float rotation = 0;          ///< radians, about +y, counter-clockwise seen from above
    bool rowsReachPoles = false; ///< SkyRows::reachPoles, as Mitsuba 3 has it

    SkyRows rows() const { return {height, rowsReachPoles}; }
    bool isConstant() const { return radiance.size() == 1; }
};

} // namespace stromboli
