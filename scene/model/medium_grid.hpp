#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <type_traits>
#include <vector>

namespace stromboli {

/// Values from place to place: numbers (float) or colours (glm::vec3), finite and not negative.
/// They are at the middles of cells that fill the unit cube; between them they are interpolated
/// linearly, and up to the cube's faces the outermost ones go on.
template <class Value>
struct Grid {
    /// What is computed with.
    using Exact = std::conditional_t<std::is_same_v<Value, float>, double, glm::dvec3>;

    glm::uvec3 size{0};        ///< values along x, y and z, at least 1
    std::vector<Value> values; ///< x changes fastest
    /// Rows of the matrix from the world to the unit cube.
    std::array<glm::dvec4, 3> toUnit{glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 1, 0, 0),
                                     glm::dvec4(0, 0, 1, 0)};

    /// At a place of the unit cube; outside of it there is nothing.
    Exact at(const glm::dvec3& place) const;
    /// The same, but the outermost values go on outside.
    Exact goingOn(const glm::dvec3& place) const;
    glm::dvec3 place(const glm::dvec3& world) const;
    /// matrix: from the unit cube to the world.
    void setWorld(const glm::dmat4& matrix);
    Value largest() const; ///< of colours, by channel
};

/// How dense a medium is.
using DensityGrid = Grid<float>;
using ColorGrid = Grid<glm::vec3>;

/// Numbers of which none is less than any channel of the colour there.
DensityGrid largestChannels(const ColorGrid& colors);

} // namespace stromboli
