#include "scene/mitsuba/mesh_files.hpp"

#include "scene/obj/load_obj.hpp"
#include "scene/ply/load_ply.hpp"

namespace stromboli::mitsuba {
namespace {

/// All triangles of a scene.
FileMesh meshOf(Context& context, const Scene& scene) {
    for (const std::string& line : scene.report.warnings)
        context.report().warn(line);
    FileMesh found;
    build::Mesh& mesh = found.mesh;
    mesh.positions.assign(scene.positions.begin(), scene.positions.end());
    mesh.normals.assign(scene.normals.begin(), scene.normals.end());
    mesh.attributes = scene.attributes;
    for (const VertexAttributes& a : mesh.attributes) {
        found.hasCoordinates = found.hasCoordinates || a.uv[0] != glm::vec2(0);
        found.hasColors = found.hasColors || a.color != glm::vec4(1);
    }
    build::MeshPart& part = mesh.parts.emplace_back();
    for (size_t i = 0; i < scene.triangles.size(); ++i) {
        const Triangle& t = scene.triangles[i];
        build::MeshTriangle& triangle = part.emplace_back();
        for (size_t k = 0; k < 3; ++k)
            triangle[k] = {t.corner[k], t.normals[k],
                           scene.attributeCorners.empty() ? kNoAttributes
                                                          : scene.attributeCorners[i][k]};
    }
    return found;
}

/// What the file says of materials would be read for nothing.
SceneConventions conventionsOf(const Context& context) {
    SceneConventions conventions = context.builder.conventions();
    conventions.defaultLight = false;
    return conventions;
}

} // namespace

FileMesh readObjMesh(Context& context, const std::filesystem::path& file) {
    return meshOf(context, loadObj(file, conventionsOf(context)));
}

FileMesh readPlyMesh(Context& context, const std::filesystem::path& file,
                     std::string_view attribute) {
    PlyAttribute colors;
    constexpr std::string_view kOfFaces = "face_", kOfVertices = "vertex_";
    colors.isOfFaces = attribute.starts_with(kOfFaces);
    if (colors.isOfFaces) colors.name = attribute.substr(kOfFaces.size());
    if (attribute.starts_with(kOfVertices)) colors.name = attribute.substr(kOfVertices.size());
    return meshOf(context, loadPlyWith(colors, file, conventionsOf(context)));
}

} // namespace stromboli::mitsuba
