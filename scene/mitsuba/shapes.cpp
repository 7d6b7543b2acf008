#include "scene/mitsuba/shapes.hpp"

#include "scene/build/corner_paint.hpp"
#include "scene/build/read_file.hpp"
#include "scene/build/surface_mesh.hpp"
#include "scene/build/tangents.hpp"
#include "scene/build/tolerate.hpp"
#include "scene/build/vectors.hpp"
#include "scene/mitsuba/hair.hpp"
#include "scene/mitsuba/heightfield.hpp"
#include "scene/mitsuba/obj_materials.hpp"
#include "scene/mitsuba/sdf_grid.hpp"
#include "scene/mitsuba/serialized.hpp"
#include "scene/mitsuba/smooth_normals.hpp"
#include "scene/mitsuba/solids.hpp"

#include <fmt/format.h>
#include <glm/ext/matrix_transform.hpp>

#include <array>

namespace stromboli::mitsuba {
namespace {

/// What the plugin's parameters of its own say about a sphere of radius 1 about the origin.
glm::dmat4 sphereMatrix(const Plugin& sphere) {
    const glm::dvec3 center = sphere.vector("center").value_or(glm::dvec3(0));
    const double radius = sphere.number("radius", 0).value_or(1);
    if (!(radius > 0)) sphere.fail("radius", "is 0, expected more");
    const glm::dmat4 identity(1.0);
    return glm::translate(identity, center) * glm::scale(identity, glm::dvec3(radius));
}

/// Groups that name each other twice hold 2^n shapes.
constexpr size_t kMostParts = 1'000'000;

/// Corners get coordinates of their colours' picture (paintOfCorners).
void spreadCorners(build::Mesh& mesh) {
    mesh.attributes = build::spreadCorners(mesh.attributes, mesh.parts.front(), 1, 0);
}

/// A mesh that is in a file as such.
bool isFile(const Plugin& shape) {
    return shape.type == "obj" || shape.type == "ply" || shape.type == "serialized";
}

} // namespace

void Shapes::place(const Plugin& shape) {
    if (shape.type == "shapegroup") return void(group(shape));
    for (const Part& part : partsOf(shape))
        context_.builder.place(shape.place, part.shape, context_.worldFromFile * part.toWorld,
                               part.materials, part.plugin->displayName());
}

std::vector<Shapes::Part> Shapes::partsOf(const Plugin& shape) {
    if (shape.type == "instance" || shape.type == "animatedinstance") return instance(shape);
    if (shape.type == "merge") return group(shape);
    if (shape.type == "shapegroup") shape.fail("is a shape group inside of a shape");
    return {single(shape)};
}

const std::vector<Shapes::Part>& Shapes::group(const Plugin& plugin) {
    const auto [found, isNew] = groups_.try_emplace(&plugin);
    if (!isNew) return found->second;
    std::vector<Part> parts;
    for (const Plugin* shape : plugin.childrenOf("shape")) {
        build::tolerate(context_.report(), build::Shortfall::Geometry, [&] {
            if (shape->type == "instance") shape->fail("is an instance inside of a shape group");
            for (const Part& part : partsOf(*shape))
                parts.push_back(part);
        });
        if (parts.size() > kMostParts) plugin.fail("has more than a million shapes");
    }
    plugin.requireAllRead();
    return groups_[&plugin] = std::move(parts);
}

std::vector<Shapes::Part> Shapes::instance(const Plugin& shape) {
    const Plugin* inside = shape.onlyChildOf("shape");
    if (!inside || inside->type != "shapegroup") shape.fail("has no shape group to show");
    std::vector<Part> parts = group(*inside);
    const glm::dmat4 toWorld = shape.transform("to_world");
    for (Part& part : parts)
        part.toWorld = toWorld * part.toWorld;
    shape.requireAllRead();
    return parts;
}

/// In Mitsuba 3 what a transform mirrors is turned inside out where its normals come from its
/// corners or, of a sphere, from its parameters: those of a file are mirrored with it.
bool Shapes::isInsideOut(const Plugin& shape) {
    if (shape.isOld || !(glm::determinant(glm::dmat3(shape.transform("to_world"))) < 0))
        return false;
    if (shape.type == "sphere") return true;
    if (!isFile(shape)) return false;
    if (shape.flag("face_normals").value_or(false)) return true;
    if (shape.type == "serialized") return read(shape, "").mesh.normals.empty();
    return !statesNormals(context_.document.file(shape, "filename"));
}

Shapes::Part Shapes::single(const Plugin& shape) {
    if (usesOwnMaterials(shape)) return withOwnMaterials(shape);
    for (const char* unused : {"load_materials", "collapse", "srgb"})
        shape.skip(unused);
    const BoundMaterial material = materials_.of(shape, [&](const Paint& paint) {
        const std::string& attribute = usableAttribute(shape, paint.attribute);
        const build::Mesh mesh =
            attribute.empty() ? meshOf(shape, {}) : read(shape, attribute).mesh;
        TextureImage image = build::paintOfCorners(mesh.attributes, mesh.parts.front(),
                                                   paint.layout, paint.isFraction);
        image.name = "mesh attribute";
        return image;
    });
    Part part{&shape, {}, shape.transform("to_world"), {material.number}};
    const bool isSphere = shape.type == "sphere";
    if (isSphere) part.toWorld *= sphereMatrix(shape);
    bool flips = shape.flag("flip_normals").value_or(false);
    if (isInsideOut(shape)) flips = !flips;
    const bool staysSphere =
        isSphere && !flips && !material.wantsCoordinates() && build::isSimilarity(part.toWorld);
    if (staysSphere) {
        usableAttribute(shape, material.cornerColors);
        part.shape = context_.builder.addSphere(shape.displayName(), 1);
    } else {
        build::Mesh mesh = meshOf(shape, material);
        if (flips) build::flip(mesh);
        part.shape = context_.builder.addMesh(shape.displayName(), std::move(mesh));
    }
    shape.requireAllRead();
    return part;
}

/// One part for each material.
Shapes::Part Shapes::withOwnMaterials(const Plugin& shape) {
    const FileMesh& file = read(shape, "");
    build::Mesh mesh = file.mesh;
    const std::vector<BoundMaterial> bound =
        bindOwnMaterials(context_, materials_, shape, file, mesh);
    Part part{&shape, {}, shape.transform("to_world"), {}};
    BoundMaterial all;
    for (const BoundMaterial& material : bound) {
        part.materials.push_back(material.number);
        all.isTextured |= material.isTextured;
        all.wantsTangents |= material.wantsTangents;
    }
    shape.skip("collapse");
    finish(shape, file, all, mesh);
    if (shape.flag("flip_normals").value_or(false)) build::flip(mesh);
    part.shape = context_.builder.addMesh(shape.displayName(), std::move(mesh));
    shape.requireAllRead();
    return part;
}

build::Mesh Shapes::meshOf(const Plugin& shape, const BoundMaterial& material) {
    if (isFile(shape)) return fileMesh(shape, material);
    usableAttribute(shape, material.cornerColors);
    build::Mesh mesh = solidOf(shape);
    if (material.isPainted) spreadCorners(mesh);
    fitTo(shape, material, mesh);
    return mesh;
}

/// Not each mesh has the attribute that its bsdf asks for; empty: it is white, which is said.
const std::string& Shapes::usableAttribute(const Plugin& shape, const std::string& attribute) {
    static const std::string kNone;
    if (attribute.empty()) return kNone;
    std::string problem;
    if (!isFile(shape))
        problem = "has a bsdf with a mesh attribute, expected a mesh from a file that has it";
    else if (attribute != "vertex_color" && shape.type != "ply")
        problem = fmt::format("has a bsdf of {}, expected a mesh from a PLY file", attribute);
    else if (!read(shape, attribute).hasColors)
        problem = fmt::format("has a bsdf of {}, and its file has no such attribute", attribute);
    if (problem.empty()) return attribute;
    shape.replace(build::Shortfall::Attribute, problem);
    return kNone;
}

build::Mesh Shapes::solidOf(const Plugin& shape) {
    if (shape.type == "sphere") return build::sphereMesh(build::kSphereSides);
    if (shape.type == "rectangle") return rectangleMesh();
    if (shape.type == "cube") return cubeMesh();
    if (shape.type == "disk") return diskMesh();
    if (isHair(shape)) return hairMesh(context_, shape);
    if (shape.type == "heightfield") return heightfieldMesh(context_, shape);
    if (shape.type == "sdfgrid") return sdfGridMesh(context_, shape);
    if (shape.type == "cylinder") {
        const glm::dvec3 from = shape.vector("p0").value_or(glm::dvec3(0));
        const glm::dvec3 to = shape.vector("p1").value_or(glm::dvec3(0, 0, 1));
        const double radius = shape.number("radius", 0).value_or(1);
        if (!build::unit(to - from) || !(radius > 0)) shape.fail("has no length or no radius");
        return cylinderMesh(from, to, radius, shape.isOld);
    }
    shape.fail(fmt::format(
        "'{}' is no shape that is read, expected obj, ply, serialized, rectangle, cube, "
        "sphere, disk, cylinder, hair, linearcurve, bsplinecurve, heightfield, sdfgrid, "
        "shapegroup, "
        "instance or merge",
        shape.type));
}

build::Mesh Shapes::fileMesh(const Plugin& shape, const BoundMaterial& material) {
    const std::string& attribute = usableAttribute(shape, material.cornerColors);
    const FileMesh& file = read(shape, attribute);
    build::Mesh mesh = file.mesh;
    if (attribute.empty())
        for (VertexAttributes& a : mesh.attributes)
            a.color = glm::vec4(1);
    finish(shape, file, material, mesh);
    return mesh;
}

/// Makes of a file's mesh what the shape says.
void Shapes::finish(const Plugin& shape, const FileMesh& file, const BoundMaterial& material,
                    build::Mesh& mesh) {
    if (material.isPainted) spreadCorners(mesh);
    if (material.wantsCoordinates() && !file.hasCoordinates)
        context_.report().warn(fmt::format("{}: has no texture coordinates, which its bsdf looks "
                                           "up pictures by; (0, 0) is taken",
                                           shape.displayName()));
    // Pictures have their first row at the coordinate 0; the readers of meshes turn v upside down,
    // as Mitsuba does with that of OBJ files, and with that of others if asked to.
    const bool isFlipped =
        shape.flag("flip_tex_coords").value_or(shape.type == "obj" && !shape.isAncient);
    if (!isFlipped)
        for (VertexAttributes& a : mesh.attributes)
            a.uv[0].y = 1 - a.uv[0].y;
    const std::optional<double> angle = shape.number("max_smooth_angle", 0, 180);
    const bool isFlat = shape.flag("face_normals").value_or(mesh.isFlat && !angle);
    if (isFlat)
        build::makeFlat(mesh);
    else if (angle)
        smoothUpTo(mesh, *angle);
    else if (mesh.normals.empty())
        build::computeNormals(mesh);
    fitTo(shape, material, mesh);
}

/// Corners have attributes only where something looks at them.
void Shapes::fitTo(const Plugin& shape, const BoundMaterial& material, build::Mesh& mesh) {
    if (material.wantsTangents) {
        build::computeTangents(mesh, 0, 0);
        // Mitsuba's frames are right-handed, whichever way v grows, and whatever is mirrored.
        const bool isMirrored = glm::determinant(glm::dmat3(shape.transform("to_world"))) < 0;
        for (VertexAttributes& a : mesh.attributes)
            if (a.tangent.w != 0) a.tangent.w = isMirrored ? -1 : 1;
    }
    if (material.wantsCoordinates() || material.isPainted || !material.cornerColors.empty()) return;
    mesh.attributes.clear();
    for (build::MeshPart& part : mesh.parts)
        for (build::MeshTriangle& triangle : part)
            for (build::Corner& corner : triangle)
                corner.attributes = kNoAttributes;
}

const FileMesh& Shapes::read(const Plugin& shape, const std::string& attribute) {
    const std::filesystem::path file = context_.document.file(shape, "filename");
    const bool isSerialized = shape.type == "serialized";
    const int64_t index = isSerialized ? shape.integer("shape_index").value_or(0) : 0;
    if (index < 0) shape.fail("shape_index", "is less than 0");
    // Mitsuba 0.x decodes colours of vertices, floats too, unless it is told not to.
    const std::optional<bool> areSrgb =
        shape.isOld ? std::optional(shape.flag("srgb").value_or(true)) : std::nullopt;
    const bool wantsLook = shape.type == "obj" && usesOwnMaterials(shape);
    const auto [found, isNew] =
        files_.try_emplace(std::tuple(file.string(), index, attribute, wantsLook, areSrgb));
    std::optional<FileMesh>& mesh = found->second;
    if (!isNew && !mesh) shape.fail("names a file that cannot be read, as was said before");
    if (isNew && isSerialized)
        mesh = serializedMesh(build::readFile(file), file.string(), uint64_t(index),
                              context_.report());
    else if (isNew && shape.type == "obj")
        mesh = readObjMesh(context_, file, wantsLook, shape);
    else if (isNew)
        mesh = readPlyMesh(context_, file, attribute, areSrgb);
    return *mesh;
}

} // namespace stromboli::mitsuba
