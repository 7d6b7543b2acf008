#include "scene/model/placements.hpp"

#include <algorithm>
#include <cmath>

namespace stromboli {
namespace {

/// The row in the order of the shader's operations; without contraction (-ffp-contract=off).
float rowTimes(const glm::vec4& row, const glm::vec3& p) {
    return ((row.x * p.x + row.y * p.y) + row.z * p.z) + row.w;
}

double largestEntry(const glm::dmat3& m) {
    double largest = 0;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            largest = std::max(largest, std::abs(m[column][row]));
    return largest;
}

bool isFinite(const glm::dmat3& m, const glm::dvec3& offset) {
    double sum = offset.x + offset.y + offset.z;
    for (int column = 0; column < 3; ++column)
        sum += m[column].x + m[column].y + m[column].z;
    return std::isfinite(float(sum)) && std::isfinite(sum);
}

} // namespace

glm::vec3 placed(const Placement& placement, const glm::vec3& point) {
    return {rowTimes(placement.toWorld[0], point), rowTimes(placement.toWorld[1], point),
            rowTimes(placement.toWorld[2], point)};
}

PlacementMatrices matricesOf(const Placement& placement) {
    PlacementMatrices m;
    for (int row = 0; row < 3; ++row) {
        for (int column = 0; column < 3; ++column)
            m.linear[column][row] = placement.toWorld[size_t(row)][column];
        m.offset[row] = placement.toWorld[size_t(row)][3];
    }
    // Scaled, or the products of a determinant could overflow or vanish.
    const double scale = largestEntry(m.linear);
    const glm::dmat3 scaled = m.linear / scale;
    m.mirrors = glm::determinant(scaled) < 0;
    m.inverseLinear = glm::inverse(scaled) / scale;
    m.inverseOffset = -(m.inverseLinear * m.offset);
    return m;
}

std::optional<Placement> placementOf(const glm::dmat4& toWorld) {
    constexpr double kMostStretch = 0x1p16;
    Placement placement;
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
            placement.toWorld[size_t(row)][column] = float(toWorld[column][row]);
    const PlacementMatrices m = matricesOf(placement);
    if (!isFinite(m.linear, m.offset) || !isFinite(m.inverseLinear, m.inverseOffset))
        return std::nullopt;
    // Bounds by the norms of largest entries, which exceed those of lengths by no more than 3.
    if (!(largestEntry(m.linear) * largestEntry(m.inverseLinear) <= kMostStretch))
        return std::nullopt;
    return placement;
}

std::vector<Bounds> prototypeBounds(const Scene& scene) {
    std::vector<Bounds> bounds(scene.prototypes.size());
    for (size_t i = 0; i < bounds.size(); ++i) {
        const Prototype& p = scene.prototypes[i];
        for (uint32_t t = p.firstTriangle; t < p.firstTriangle + p.triangles; ++t)
            for (const uint32_t corner : scene.triangles[t].corner)
                bounds[i].extend(scene.positions[corner]);
    }
    return bounds;
}

Bounds boundsInWorld(const Placement& placement, const Bounds& box) {
    Bounds world;
    if (box.empty()) return world;
    const glm::dvec3 middle = (glm::dvec3(box.lo) + glm::dvec3(box.hi)) / 2.0;
    const glm::dvec3 half = (glm::dvec3(box.hi) - glm::dvec3(box.lo)) / 2.0;
    const glm::dvec3 largest = glm::max(glm::abs(glm::dvec3(box.lo)), glm::abs(glm::dvec3(box.hi)));
    for (size_t row = 0; row < 3; ++row) {
        const glm::dvec4 m(placement.toWorld[row]);
        const glm::dvec3 size = glm::abs(glm::dvec3(m));
        const double at = glm::dot(glm::dvec3(m), middle) + m.w;
        // Corners are rounded four times at most; 2^-21 is 8 such roundings.
        const double reach =
            glm::dot(size, half) + 0x1p-21 * (glm::dot(size, largest) + std::abs(m.w));
        const auto axis = glm::length_t(row);
        world.lo[axis] = std::nextafter(float(at - reach), -HUGE_VALF);
        world.hi[axis] = std::nextafter(float(at + reach), HUGE_VALF);
    }
    return world;
}

} // namespace stromboli
