#include "scene/mitsuba/mesh_files.hpp"

#include "scene/build/mesh_of_scene.hpp"
#include "scene/build/read_file.hpp"
#include "scene/mitsuba/obj_materials.hpp"
#include "scene/obj/load_obj.hpp"
#include "scene/ply/load_ply.hpp"

#include <fmt/format.h>

namespace stromboli::mitsuba {
namespace {

/// A line about materials, which the scene's file has others for.
bool isAboutLook(const std::string& line) {
    for (const char* sign : {"<mtllib>", "<usemtl>", ".mtl:", "map_", "picture"})
        if (line.find(sign) != std::string::npos) return true;
    return false;
}

/// All triangles of a scene.
FileMesh meshOf(Context& context, const Scene& scene, bool wantsLook) {
    context.report().adopt(
        scene.report, [&](const std::string& line) { return !wantsLook && isAboutLook(line); });
    FileMesh found;
    found.mesh = build::meshOfScene(scene);
    for (const VertexAttributes& a : found.mesh.attributes) {
        found.hasCoordinates = found.hasCoordinates || a.uv[0] != glm::vec2(0);
        found.hasColors = found.hasColors || a.color != glm::vec4(1);
    }
    if (wantsLook)
        for (const Triangle& t : scene.triangles)
            found.materials.push_back(t.material);
    return found;
}

/// What the file says of materials would be read for nothing.
SceneConventions conventionsOf(const Context& context) {
    SceneConventions conventions = context.builder.conventions();
    conventions.defaultLight = false;
    conventions.strict = false; // Report::adopt is strict with what has a meaning
    return conventions;
}

} // namespace

bool statesNormals(const std::filesystem::path& file) {
    const std::string bytes = build::readFile(file);
    const std::string_view text = bytes;
    if (!text.starts_with("ply")) return text.starts_with("vn ") || text.find("\nvn ") != text.npos;
    const std::string_view head = text.substr(0, text.find("end_header"));
    return head.find(" nx") != head.npos;
}

FileMesh readObjMesh(Context& context, const std::filesystem::path& file, bool wantsLook,
                     const Plugin& shape) {
    SceneConventions conventions = conventionsOf(context);
    conventions.onUnknownMaterial = [&](const std::string& material) {
        if (wantsLook && !bsdfFor(shape, material))
            context.report().forgive(shape.place,
                                     fmt::format("there is no material '{}'", material),
                                     "such a surface is mid grey");
    };
    Scene scene = loadObj(file, conventions);
    FileMesh found = meshOf(context, scene, wantsLook);
    if (wantsLook)
        found.look = {std::move(scene.materials), std::move(scene.textures),
                      std::move(scene.images)};
    return found;
}

FileMesh readPlyMesh(Context& context, const std::filesystem::path& file,
                     std::string_view attribute, std::optional<bool> areSrgb) {
    PlyAttribute colors;
    colors.areSrgb = areSrgb;
    colors.mayBeBytes = false; // Mitsuba takes them as they are
    constexpr std::string_view kOfFaces = "face_", kOfVertices = "vertex_";
    colors.isOfFaces = attribute.starts_with(kOfFaces);
    if (colors.isOfFaces) colors.name = attribute.substr(kOfFaces.size());
    if (attribute.starts_with(kOfVertices)) colors.name = attribute.substr(kOfVertices.size());
    return meshOf(context, loadPlyWith(colors, file, conventionsOf(context)), false);
}

} // namespace stromboli::mitsuba
