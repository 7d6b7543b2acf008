#pragma once

#include <glm/glm.hpp>

#include <optional>

namespace stromboli::build {

/// Coordinates beyond 2^60 are left out: below it the traversal's products stay finite in single
/// precision (scene/README.md).
inline constexpr double kLargestCoordinate = 1152921504606846976.0;

/// True if no component is NaN or infinite.
bool isFinite(const glm::dvec3& v);
bool isFinite(const glm::dmat4& matrix);

/// The vector made unit, whatever its length; nothing if it has no direction.
std::optional<glm::dvec3> unit(const glm::dvec3& v);

/// The angle at `corner` between the ways to two other points, in [0, pi]; nothing if one of them
/// is at the corner.
std::optional<double> angleAt(const glm::dvec3& corner, const glm::dvec3& a, const glm::dvec3& b);

/// True for finite points whose coordinates the renderer accepts.
bool inRange(const glm::dvec3& p);

/// The lengths of the three axes of a matrix.
glm::dvec3 axisLengths(const glm::dmat4& toWorld);

/// True if lengths differ by more than files, which carry about six digits, mean by chance.
bool areUnequal(const glm::dvec3& lengths);

/// True if a matrix turns, moves, mirrors and scales alike in all directions, so that a sphere
/// stays one.
bool isSimilarity(const glm::dmat4& m);

} // namespace stromboli::build
