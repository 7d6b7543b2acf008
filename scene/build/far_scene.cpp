// The part of SceneBuilder that keeps the precision of scenes far from the origin.

#include "scene/build/scene_builder.hpp"
#include "scene/build/vectors.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

namespace stromboli::build {
namespace {

/// A box of doubles; empty by default.
struct Box {
    glm::dvec3 lo{std::numeric_limits<double>::infinity()}, hi = -lo;

    void extend(const glm::dvec3& p) {
        if (inRange(p)) lo = glm::min(lo, p), hi = glm::max(hi, p);
    }
    bool empty() const { return !(lo.x <= hi.x); }
    glm::dvec3 middle() const { return 0.5 * (lo + hi); }
    double diagonal() const { return glm::length(hi - lo); }
};

Box boxOf(const Mesh& mesh) {
    Box box;
    for (const glm::dvec3& p : mesh.positions)
        box.extend(p);
    return box;
}

void extendByCorners(Box& box, const Box& other, const glm::dmat4& toWorld) {
    if (other.empty()) return;
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p(corner & 1 ? other.hi.x : other.lo.x,
                           corner & 2 ? other.hi.y : other.lo.y,
                           corner & 4 ? other.hi.z : other.lo.z);
        box.extend(glm::dvec3(toWorld * glm::dvec4(p, 1)));
    }
}

/// Where the origin should be for what lies in the box; nothing where it is good where it is.
/// Positions are rounded to floats, to 2^-25 of their distance from the origin. In a scene that is
/// 64 times as far away as it is large that is 2^-19 of its size, which begins to show; in a town
/// in the coordinates of its country it is half a metre. Whole numbers, so that the numbers of the
/// file can be told in what is left of them.
std::optional<glm::dvec3> originFor(const Box& box) {
    constexpr double kFar = 64;
    if (box.empty()) return std::nullopt;
    const glm::dvec3 middle = box.middle();
    if (!(glm::length(middle) > kFar * box.diagonal())) return std::nullopt;
    return box.diagonal() > 2 ? glm::round(middle) : middle;
}

} // namespace

/// The mesh about its own middle; `use` places it where it was.
void SceneBuilder::centreMeshes() {
    std::vector<std::optional<glm::dvec3>> moved(shapes_.size());
    for (size_t i = 0; i < shapes_.size(); ++i) {
        Mesh* mesh = std::get_if<Mesh>(&shapes_[i].form);
        if (!mesh) continue;
        moved[i] = originFor(boxOf(*mesh));
        if (!moved[i]) continue;
        for (glm::dvec3& p : mesh->positions)
            p -= *moved[i];
    }
    for (MeshUse& use : meshes_)
        if (const auto& by = moved[use.shape]) use.toWorld[3] = use.toWorld * glm::dvec4(*by, 1);
}

void SceneBuilder::moveOrigin() {
    // That renderer's directions and framing are about the origin of the file.
    if (conventions_.directionalAim == DirectionalAim::NodePoint || scene_.cglDialect) return;
    centreMeshes();
    std::vector<Box> boxes;
    for (const Shape& shape : shapes_) {
        const Mesh* mesh = std::get_if<Mesh>(&shape.form);
        boxes.push_back(mesh ? boxOf(*mesh) : Box());
    }
    // What an animation moves does not count where anything stands still, so that what stands still
    // stays where it is from one moment to the next.
    const bool allMove = std::ranges::all_of(
        meshes_, [&](const MeshUse& use) { return scene_.moves(use.instance); });
    Box box;
    for (const MeshUse& use : meshes_)
        if (allMove || !scene_.moves(use.instance))
            extendByCorners(box, boxes[use.shape], use.toWorld);
    for (size_t i = 0; i < scene_.spheres.size(); ++i) {
        box.extend(sphereCenters_[i] - double(scene_.spheres[i].radius));
        box.extend(sphereCenters_[i] + double(scene_.spheres[i].radius));
    }
    const std::optional<glm::dvec3> origin = originFor(box);
    if (!origin) return;
    scene_.origin = *origin;
    for (MeshUse& use : meshes_)
        use.toWorld[3] -= glm::dvec4(*origin, 0);
    for (size_t i = 0; i < scene_.spheres.size(); ++i)
        scene_.spheres[i].center = sphereCenters_[i] - *origin;
    for (size_t i = 0; i < scene_.lights.size(); ++i)
        scene_.lights[i].position = lightPlaces_[i] - *origin;
    for (size_t i = 0; i < scene_.portals.size(); ++i)
        scene_.portals[i].corner = portalCorners_[i] - *origin;
    for (Medium& medium : scene_.media)
        for (std::array<glm::dvec4, 3>* rows : medium.places())
            for (glm::dvec4& row : *rows)
                row.w += glm::dot(glm::dvec3(row), *origin);
    for (FileCamera& camera : scene_.cameras) {
        camera.position -= *origin;
        camera.pointAhead -= *origin;
    }
    report_.assume(
        fmt::format("the scene lies far from the origin: it is rendered about ({}, {}, {}), "
                    "and shown in the coordinates of the file",
                    origin->x, origin->y, origin->z));
}

} // namespace stromboli::build
