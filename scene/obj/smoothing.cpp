#include "scene/obj/smoothing.hpp"

#include "scene/build/number_word.hpp"
#include "scene/build/vectors.hpp"

#include <glm/geometric.hpp>

#include <cmath>
#include <functional>
#include <optional>

namespace stromboli::obj {

void Smoothing::enter(std::string_view group) {
    group_ = 0;
    if (group.empty() || group == "off") return;
    const std::optional<int64_t> number = build::integerIn(group);
    group_ = number ? uint32_t(*number) : uint32_t(std::hash<std::string_view>()(group)) | 1u;
}

void Smoothing::apply(std::span<build::Corner> polygon, const std::vector<glm::dvec3>& positions,
                      uint32_t first, std::vector<glm::dvec3>& normals) {
    const size_t count = polygon.size();
    const auto at = [&](size_t i) { return positions[polygon[i % count].position]; };
    glm::dvec3 normal(0); // by Newell's sums, which take polygons that are not quite flat
    for (size_t i = 0; i < count; ++i)
        normal += glm::cross(at(i) - at(0), at(i + 1) - at(0));
    const double length = glm::length(normal);
    if (!(length > 0) || !std::isfinite(length)) return;
    normal /= length;
    for (size_t i = 0; i < count; ++i) {
        // A corner twice in a row has no angle; it has a normal all the same, since a face has them
        // at all of its corners or at none.
        const double angle = build::angleAt(at(i), at(i + count - 1), at(i + 1)).value_or(0);
        const uint64_t key = uint64_t(group_) << 32 | polygon[i].position;
        const auto [found, isNew] = normals_.try_emplace(key, uint32_t(normals.size()));
        if (isNew) normals.emplace_back(0);
        normals[found->second] += angle * normal;
        polygon[i].normal = first + found->second;
    }
}

} // namespace stromboli::obj
