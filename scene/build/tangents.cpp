#include "scene/build/tangents.hpp"

#include "scene/build/vectors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <optional>
#include <tuple>
#include <utility>

namespace stromboli::build {
namespace {

/// What decides whether corners share a tangent.
using PlaceKey = std::array<double, 8>;

/// A corner of a part while its tangent is looked for.
struct TangentCorner {
    glm::dvec3 position, normal;
    glm::dvec2 uv;
    uint32_t place = 0; ///< the same for corners of equal position, normal and uv

    PlaceKey key() const {
        return {position.x, position.y, position.z, normal.x, normal.y, normal.z, uv.x, uv.y};
    }
};

/// Sums at a place: of triangles that the picture covers as it is, and mirrored.
using TangentSums = std::array<glm::dvec3, 2>;

/// The part of a vector across a unit normal, made unit.
std::optional<glm::dvec3> across(const glm::dvec3& normal, const glm::dvec3& v) {
    return unit(v - glm::dot(normal, v) * normal);
}

/// Any unit vector across a unit normal: from the axis that is least along it.
glm::dvec3 anyAcross(const glm::dvec3& normal) {
    const glm::dvec3 size = glm::abs(normal);
    const glm::dvec3 axis = size.x <= size.y && size.x <= size.z ? glm::dvec3(1, 0, 0)
                            : size.y <= size.z                   ? glm::dvec3(0, 1, 0)
                                                                 : glm::dvec3(0, 0, 1);
    return across(normal, axis).value_or(glm::dvec3(1, 0, 0));
}

std::vector<TangentCorner> cornersOf(const Mesh& mesh, const MeshPart& part, int uvSet) {
    std::vector<TangentCorner> corners;
    corners.reserve(part.size() * 3);
    for (const MeshTriangle& t : part) {
        const glm::dvec3& a = mesh.positions[t[0].position];
        const glm::dvec3 face =
            unit(glm::cross(mesh.positions[t[1].position] - a, mesh.positions[t[2].position] - a))
                .value_or(glm::dvec3(0, 0, 1));
        for (const Corner& corner : t) {
            TangentCorner c;
            c.position = mesh.positions[corner.position];
            c.normal = corner.normal == kNoNormals
                           ? face
                           : unit(mesh.normals[corner.normal]).value_or(face);
            if (corner.attributes != kNoAttributes)
                c.uv = mesh.attributes[corner.attributes].uv[uvSet];
            else
                c.uv = glm::dvec2(0);
            corners.push_back(c);
        }
    }
    return corners;
}

/// Numbers the places; returns how many there are.
size_t numberPlaces(std::vector<TangentCorner>& corners) {
    std::vector<uint32_t> order(corners.size());
    std::iota(order.begin(), order.end(), 0u);
    std::sort(order.begin(), order.end(),
              [&](uint32_t a, uint32_t b) { return corners[a].key() < corners[b].key(); });
    uint32_t place = 0;
    for (size_t i = 0; i < order.size(); ++i) {
        if (i > 0 && corners[order[i - 1]].key() != corners[order[i]].key()) ++place;
        corners[order[i]].place = place;
    }
    return corners.empty() ? 0 : place + 1;
}

/// Twice the triangle's area in the picture as it is shown, v pointing up: positive if the picture
/// is not mirrored on it.
double pictureArea(const TangentCorner* t) {
    const glm::dvec2 b = t[1].uv - t[0].uv, c = t[2].uv - t[0].uv;
    return b.y * c.x - b.x * c.y;
}

/// The derivative of the position by u, up to a positive factor.
glm::dvec3 alongU(const TangentCorner* t, double area) {
    const glm::dvec2 b = t[1].uv - t[0].uv, c = t[2].uv - t[0].uv;
    const glm::dvec3 slope =
        b.y * (t[2].position - t[0].position) - c.y * (t[1].position - t[0].position);
    return area > 0 ? slope : -slope;
}

/// The angle of a triangle at one of its corners, seen along the corner's normal.
double angleAt(const TangentCorner* t, int corner) {
    const TangentCorner& here = t[corner];
    const auto toNext = across(here.normal, t[(corner + 1) % 3].position - here.position);
    const auto toLast = across(here.normal, t[(corner + 2) % 3].position - here.position);
    if (!toNext || !toLast) return 0;
    return std::acos(std::clamp(glm::dot(*toNext, *toLast), -1.0, 1.0));
}

std::vector<TangentSums> sumTangents(const std::vector<TangentCorner>& corners, size_t places) {
    std::vector<TangentSums> sums(places, TangentSums{glm::dvec3(0), glm::dvec3(0)});
    for (size_t first = 0; first < corners.size(); first += 3) {
        const TangentCorner* t = &corners[first];
        const double area = pictureArea(t);
        if (area == 0 || !std::isfinite(area)) continue;
        const glm::dvec3 slope = alongU(t, area);
        for (int i = 0; i < 3; ++i)
            if (const auto tangent = across(t[i].normal, slope))
                sums[t[i].place][area < 0] += angleAt(t, i) * *tangent;
    }
    return sums;
}

/// The tangent of a corner, and in w the sense of its bitangent.
glm::vec4 tangentOf(const TangentCorner& corner, const TangentSums& sums, double area) {
    const bool mirrored = area < 0;
    std::optional<glm::dvec3> tangent = unit(sums[mirrored]);
    bool other = false;
    if (!tangent && area == 0) { // no derivative of its own: that of a neighbour
        tangent = unit(sums[!mirrored]);
        other = tangent.has_value();
    }
    const float sense = mirrored != other ? -1.0f : 1.0f;
    return {tangent.value_or(anyAcross(corner.normal)), sense};
}

} // namespace

void computeTangents(Mesh& mesh, size_t part, int uvSet) {
    std::vector<TangentCorner> corners = cornersOf(mesh, mesh.parts[part], uvSet);
    const std::vector<TangentSums> sums = sumTangents(corners, numberPlaces(corners));
    // Corners that had the same attributes keep sharing them where their tangents are the same.
    std::map<std::tuple<uint32_t, uint32_t, float>, uint32_t> made;
    for (size_t i = 0; i < corners.size(); ++i) {
        Corner& corner = mesh.parts[part][i / 3][i % 3];
        const TangentCorner& c = corners[i];
        const glm::vec4 tangent = tangentOf(c, sums[c.place], pictureArea(&corners[i - i % 3]));
        const auto [found, isNew] = made.try_emplace({corner.attributes, c.place, tangent.w},
                                                     uint32_t(mesh.attributes.size()));
        if (isNew) {
            VertexAttributes attributes;
            if (corner.attributes != kNoAttributes) attributes = mesh.attributes[corner.attributes];
            attributes.tangent = tangent;
            mesh.attributes.push_back(attributes);
        }
        corner.attributes = found->second;
    }
}

void turnTangents(Mesh& mesh, size_t part, const glm::dvec2& uRow, const glm::dvec2& vRow) {
    const double area = uRow.x * vRow.y - uRow.y * vRow.x;
    if (area == 0 || !std::isfinite(area)) return; // one texel for all: it has no direction
    const double sense = area < 0 ? -1 : 1;
    const std::vector<TangentCorner> corners = cornersOf(mesh, mesh.parts[part], 0);
    std::vector<bool> turned(mesh.attributes.size(), false);
    for (size_t i = 0; i < corners.size(); ++i) {
        const uint32_t index = mesh.parts[part][i / 3][i % 3].attributes;
        if (index == kNoAttributes || turned[index]) continue;
        turned[index] = true;
        glm::vec4& stated = mesh.attributes[index].tangent;
        const auto tangent = across(corners[i].normal, glm::dvec3(stated));
        if (stated.w == 0 || !tangent) continue;
        // The bitangent points to where v falls: the position's derivative by u' is that by u times
        // that of u by u', and the same of v, from the inverse of the rows.
        const glm::dvec3 bitangent = double(stated.w) * glm::cross(corners[i].normal, *tangent);
        const auto along = unit(sense * (vRow.y * *tangent + vRow.x * bitangent));
        stated = {glm::vec3(along.value_or(*tangent)), stated.w * float(sense)};
    }
}

} // namespace stromboli::build
