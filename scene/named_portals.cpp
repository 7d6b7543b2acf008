#include "scene/named_portals.hpp"

#include "host/core/error.hpp"
#include "host/core/nearest_name.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <optional>

namespace stromboli {
namespace {

/// What of a rectangle's size its corners may lie beside a plane, and its area be another.
constexpr double kTolerance = 1e-3;

using Corners = std::vector<glm::dvec3>; ///< of triangles, three each

double areaOf(const Corners& corners) {
    double area = 0;
    for (size_t i = 0; i + 2 < corners.size(); i += 3)
        area +=
            0.5 * glm::length(glm::cross(corners[i + 1] - corners[i], corners[i + 2] - corners[i]));
    return area;
}

/// Unit, of the largest triangle; 0: none has an area.
glm::dvec3 normalOf(const Corners& corners) {
    glm::dvec3 largest(0);
    for (size_t i = 0; i + 2 < corners.size(); i += 3) {
        const glm::dvec3 n = glm::cross(corners[i + 1] - corners[i], corners[i + 2] - corners[i]);
        if (glm::length(n) > glm::length(largest)) largest = n;
    }
    return glm::length(largest) > 0 ? glm::normalize(largest) : largest;
}

double sizeOf(const Corners& corners) {
    glm::dvec3 lo(std::numeric_limits<double>::infinity()), hi = -lo;
    for (const glm::dvec3& p : corners)
        lo = glm::min(lo, p), hi = glm::max(hi, p);
    return glm::length(hi - lo);
}

/// The smallest rectangle in the plane of that normal around the points: one of its sides goes
/// along an edge of some triangle.
Portal rectangleAround(const Corners& corners, const glm::dvec3& normal) {
    Portal best;
    double least = std::numeric_limits<double>::infinity();
    constexpr size_t kMostEdges = 4096; // of larger meshes, some
    for (size_t i = 0; i < corners.size(); i += 1 + corners.size() / kMostEdges) {
        const glm::dvec3 edge = corners[i % 3 == 2 ? i - 2 : i + 1] - corners[i];
        const glm::dvec3 level = edge - glm::dot(edge, normal) * normal;
        if (!(glm::length(level) > 0)) continue;
        const glm::dvec3 a = glm::normalize(level), b = glm::cross(normal, a);
        glm::dvec2 lo(std::numeric_limits<double>::infinity()), hi = -lo;
        for (const glm::dvec3& p : corners) {
            const glm::dvec2 at(glm::dot(p, a), glm::dot(p, b));
            lo = glm::min(lo, at), hi = glm::max(hi, at);
        }
        const glm::dvec2 size = hi - lo;
        if (size.x * size.y >= least) continue;
        least = size.x * size.y;
        best = {glm::vec3(lo.x * a + lo.y * b + glm::dot(corners[0], normal) * normal),
                glm::vec3(size.x * a), glm::vec3(size.y * b)};
    }
    return best;
}

/// Whether a triangle is in the world and belongs to the object.
bool isOf(const Scene& scene, size_t triangle, uint32_t instance) {
    return triangle >= scene.firstInWorld() && scene.triangles[triangle].instance == instance;
}

uint32_t objectOf(const Scene& scene, const std::string& name) {
    const auto found = std::ranges::find(scene.instances, name);
    if (found == scene.instances.end())
        throw SceneError(fmt::format("{}: --portal: there is no object '{}'{}", scene.file, name,
                                     didYouMean(name, scene.instances)));
    if (std::ranges::count(scene.instances, name) > 1)
        throw SceneError(fmt::format("{}: --portal: there are several objects '{}': expected one",
                                     scene.file, name));
    return uint32_t(found - scene.instances.begin());
}

Portal portalOf(Scene& scene, const std::string& name, uint32_t instance) {
    Corners corners;
    for (size_t i = 0; i < scene.triangles.size(); ++i)
        for (const uint32_t corner : scene.triangles[i].corner)
            if (isOf(scene, i, instance)) corners.emplace_back(scene.positions[corner]);
    if (corners.empty())
        throw SceneError(fmt::format("{}: --portal: object '{}' has no triangles of its own: "
                                     "expected a rectangle (--instances off copies a mesh that "
                                     "several objects share)",
                                     scene.file, name));
    const glm::dvec3 normal = normalOf(corners);
    const bool isFlat = std::ranges::all_of(corners, [&](const glm::dvec3& p) {
        return std::abs(glm::dot(p - corners[0], normal)) <= kTolerance * sizeOf(corners);
    });
    if (normal == glm::dvec3(0) || !isFlat)
        throw SceneError(fmt::format("{}: --portal: object '{}' does not lie in a plane: expected "
                                     "a rectangle of triangles",
                                     scene.file, name));
    const Portal portal = rectangleAround(corners, normal);
    const double area = double(glm::length(portal.edgeA)) * double(glm::length(portal.edgeB));
    if (areaOf(corners) < (1 - kTolerance) * area)
        scene.report.assumed.push_back(
            fmt::format("portal '{}' is no rectangle: the smallest one around it is taken", name));
    return portal;
}

void removeTriangles(Scene& scene, uint32_t instance) {
    size_t kept = 0;
    for (size_t i = 0; i < scene.triangles.size(); ++i) {
        if (isOf(scene, i, instance)) continue;
        scene.triangles[kept] = scene.triangles[i];
        if (!scene.attributeCorners.empty())
            scene.attributeCorners[kept] = scene.attributeCorners[i];
        ++kept;
    }
    scene.triangles.resize(kept);
    if (!scene.attributeCorners.empty()) scene.attributeCorners.resize(kept);
}

} // namespace

void takePortals(Scene& scene, const std::vector<std::string>& names) {
    if (names.empty()) return;
    scene.portals.clear();
    for (const std::string& name : names) {
        const uint32_t instance = objectOf(scene, name);
        scene.portals.push_back(portalOf(scene, name, instance));
        removeTriangles(scene, instance);
    }
    if (scene.portals.size() > kMostPortals)
        scene.report.ignored.push_back(
            fmt::format("--portal: light samples aim at the first {} of {} portals", kMostPortals,
                        names.size()));
}

} // namespace stromboli
