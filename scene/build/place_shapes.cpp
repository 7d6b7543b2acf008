// The part of SceneBuilder that adds meshes and spheres.

#include "scene/build/scene_builder.hpp"
#include "scene/build/surface_mesh.hpp"
#include "scene/build/vectors.hpp"
#include "scene/model/placements.hpp"

#include <fmt/format.h>

#include <utility>

namespace stromboli::build {
ShapeId SceneBuilder::addMesh(std::string name, Mesh mesh) {
    if (triangleCount(mesh) == 0)
        report_.warn(fmt::format("geometry '{}' has no triangles", name));
    else if (mesh.normals.empty() && !mesh.isFlat &&
             conventions_.vertexNormals == VertexNormals::FromFile)
        report_.assume("a mesh without normals is shaded flat");
    shapes_.push_back({std::move(name), std::move(mesh), {}, {}});
    return ShapeId(shapes_.size() - 1);
}

ShapeId SceneBuilder::addSphere(std::string name, double radius) {
    shapes_.push_back({std::move(name), radius, {}, {}});
    return ShapeId(shapes_.size() - 1);
}

void SceneBuilder::place(const FilePlace& where, ShapeId id, const glm::dmat4& toWorld,
                         std::span<const uint32_t> materials, const std::string& instanceName) {
    placeStanding(where, id, standing(toWorld), materials, instanceName);
}

/// toWorld: into a world in which y is up.
void SceneBuilder::placeStanding(const FilePlace& where, ShapeId id, const glm::dmat4& toWorld,
                                 std::span<const uint32_t> materials,
                                 const std::string& instanceName) {
    Shape& shape = shapes_.at(size_t(id));
    if (const double* radius = std::get_if<double>(&shape.form)) {
        if (!staysSphere(*radius, toWorld))
            return placeStanding(where, stretchedSphere(id), toWorld, materials, instanceName);
        return placeSphere(*radius, toWorld, materials.front(), instanceName, shape.drops);
    }
    const Mesh& mesh = std::get<Mesh>(shape.form);
    copiedTriangles_ += triangleCount(mesh);
    if (copiedTriangles_ > kMostTriangles && !tooLargeAt_) tooLargeAt_ = where;
    meshes_.push_back({size_t(id),
                       toWorld,
                       {materials.begin(), materials.begin() + std::ptrdiff_t(mesh.parts.size())},
                       startInstance(instanceName)});
}

void SceneBuilder::markMoving() {
    scene_.movingInstances.resize(scene_.instances.size());
    scene_.movingInstances.back() = true;
}

uint32_t SceneBuilder::startInstance(const std::string& name) {
    scene_.instances.push_back(name);
    return uint32_t(scene_.instances.size() - 1);
}

void SceneBuilder::placeMeshes() {
    MeshUses uses(meshes_,
                  [&](size_t shape) -> const Mesh& { return std::get<Mesh>(shapes_[shape].form); });
    const auto place = [&](const MeshUse& use, const glm::dmat4& toWorld) {
        const Mesh& mesh = std::get<Mesh>(shapes_[use.shape].form);
        MeshPlacer placer(scene_, conventions_, mesh, toWorld, shapes_[use.shape].drops);
        for (size_t i = 0; i < mesh.parts.size(); ++i)
            for (const MeshTriangle& triangle : mesh.parts[i])
                placer.add(triangle, use.materials[i], use.instance);
    };
    if (conventions_.sharesInstances()) uses.share(scene_.materials, conventions_.instances);
    for (const MeshUses::Shared& shared : uses.shared()) {
        const auto first = uint32_t(scene_.triangles.size());
        place(meshes_[shared.uses.front()], glm::dmat4(1));
        const auto prototype = uint32_t(scene_.prototypes.size());
        scene_.prototypes.push_back({first, uint32_t(scene_.triangles.size()) - first});
        for (const size_t use : shared.uses) {
            Placement placement = *placementOf(meshes_[use].toWorld);
            placement.prototype = prototype;
            placement.instance = meshes_[use].instance;
            scene_.placements.push_back(placement);
        }
    }
    if (tooLargeAt_ && uses.copiedTriangles() > kMostTriangles)
        tooLargeAt_->fail(
            fmt::format("brings the scene to more than the {} triangles there is room "
                        "for",
                        kMostTriangles));
    for (const size_t copied : uses.copied())
        place(meshes_[copied], meshes_[copied].toWorld);
    meshes_.clear();
}

/// One without a radius or an extent in some direction is one, too, which is left out.
bool SceneBuilder::staysSphere(double radius, const glm::dmat4& toWorld) const {
    const glm::dvec3 scale = axisLengths(toWorld);
    const bool hasExtent = radius > 0 && scale.x > 0 && scale.y > 0 && scale.z > 0;
    return scene_.cglDialect || !hasExtent || isSimilarity(toWorld);
}

ShapeId SceneBuilder::stretchedSphere(ShapeId sphere) {
    if (!shapes_.at(size_t(sphere)).stretched) {
        const Shape& shape = shapes_.at(size_t(sphere));
        Mesh mesh = sphereMesh(kSphereSides);
        for (glm::dvec3& position : mesh.positions)
            position *= std::get<double>(shape.form);
        const ShapeId added = addMesh(shape.name, std::move(mesh));
        shapes_.at(size_t(sphere)).stretched = added;
    }
    return *shapes_.at(size_t(sphere)).stretched;
}

void SceneBuilder::placeSphere(double radius, const glm::dmat4& toWorld, uint32_t material,
                               const std::string& instanceName, Drops& drops) {
    const glm::dvec3 scale = axisLengths(toWorld);
    const glm::dvec3 center = toWorld[3];
    const double worldRadius = radius * scale.x;
    const bool fits = float(worldRadius) > 0 && scale.y > 0 && scale.z > 0 &&
                      inRange(center + worldRadius) && inRange(center - worldRadius);
    if (!fits) return void(++drops.spheres);
    if (areUnequal(scale))
        report_.warn(fmt::format("sphere '{}': scaled unequally; it stays a sphere with the scale "
                                 "of its x axis",
                                 instanceName));
    Sphere sphere;
    sphere.center = center;
    sphereCenters_.push_back(center);
    sphere.radius = float(worldRadius);
    sphere.material = material;
    sphere.instance = startInstance(instanceName);
    scene_.spheres.push_back(sphere);
}

void SceneBuilder::reportDrops(const Shape& shape) {
    const Drops& d = shape.drops;
    if (d.zeroArea + d.outOfRange > 0)
        report_.warn(fmt::format("mesh '{}': {} of {} triangles left out: {} of zero area, {} not "
                                 "finite or beyond 2^60",
                                 shape.name, d.zeroArea + d.outOfRange, d.triangles, d.zeroArea,
                                 d.outOfRange));
    if (d.badNormals > 0)
        report_.warn(fmt::format("mesh '{}': {} of {} triangles have zero or non-finite normals "
                                 "and are shaded flat",
                                 shape.name, d.badNormals, d.triangles));
    if (d.badTangents > 0)
        report_.warn(
            fmt::format("mesh '{}': {} corners have zero or non-finite tangents, which are "
                        "left out",
                        shape.name, d.badTangents));
    if (d.spheres > 0)
        report_.warn(fmt::format("sphere '{}': {} left out: radius not greater than 0, not finite "
                                 "or beyond 2^60",
                                 shape.name, d.spheres));
}

} // namespace stromboli::build
