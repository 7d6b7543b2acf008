#include "scene/build/vectors.hpp"

#include <algorithm>
#include <cmath>

namespace stromboli::build {

bool isFinite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

bool isFinite(const glm::dmat4& matrix) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            if (!std::isfinite(matrix[column][row])) return false;
    return true;
}

std::optional<glm::dvec3> unit(const glm::dvec3& v) {
    if (!isFinite(v) || v == glm::dvec3(0)) return std::nullopt;
    const double largest = std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
    return glm::normalize(v / largest);
}

std::optional<double> angleAt(const glm::dvec3& corner, const glm::dvec3& a, const glm::dvec3& b) {
    const std::optional<glm::dvec3> toA = unit(a - corner), toB = unit(b - corner);
    if (!toA || !toB) return {};
    return std::acos(std::clamp(glm::dot(*toA, *toB), -1.0, 1.0));
}

bool inRange(const glm::dvec3& p) {
    return std::abs(p.x) <= kLargestCoordinate && std::abs(p.y) <= kLargestCoordinate &&
           std::abs(p.z) <= kLargestCoordinate;
}

glm::dvec3 axisLengths(const glm::dmat4& toWorld) {
    return {glm::length(glm::dvec3(toWorld[0])), glm::length(glm::dvec3(toWorld[1])),
            glm::length(glm::dvec3(toWorld[2]))};
}

bool areUnequal(const glm::dvec3& lengths) {
    return std::max({lengths.x, lengths.y, lengths.z}) >
           1.0001 * std::min({lengths.x, lengths.y, lengths.z});
}

bool isSimilarity(const glm::dmat4& m) {
    const glm::dvec3 scale = axisLengths(m);
    if (areUnequal(scale) || !(scale.x > 0)) return false;
    const glm::dvec3 x = glm::dvec3(m[0]) / scale.x, y = glm::dvec3(m[1]) / scale.y,
                     z = glm::dvec3(m[2]) / scale.z;
    constexpr double kChance = 1e-6; // files carry about six digits
    return std::abs(glm::dot(x, y)) < kChance && std::abs(glm::dot(y, z)) < kChance &&
           std::abs(glm::dot(z, x)) < kChance;
}

} // namespace stromboli::build
