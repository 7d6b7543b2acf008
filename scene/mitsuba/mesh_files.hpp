#pragma once

#include "scene/build/mesh.hpp"
#include "scene/mitsuba/context.hpp"

#include <filesystem>
#include <optional>
#include <string_view>

namespace stromboli::mitsuba {

/// What an OBJ file and its libraries say of materials.
struct FileLook {
    std::vector<Material> materials;
    std::vector<Texture> textures;
    std::vector<TextureImage> images;
};

/// A mesh of one part from a file of its own. Textures have v growing downwards, as everywhere in
/// the scene. What the file says of materials has a meaning where its look was asked for.
struct FileMesh {
    build::Mesh mesh;
    bool hasCoordinates = false, hasColors = false;
    FileLook look;
    std::vector<uint32_t> materials; ///< of each triangle, into those of the look
};

/// Whether an OBJ or PLY file states normals, be they those of its triangles, which readers leave
/// out.
bool statesNormals(const std::filesystem::path& file);

/// wantsLook: the file's materials are asked for, by a shape that may have bsdfs in their place.
FileMesh readObjMesh(Context& context, const std::filesystem::path& file, bool wantsLook,
                     const Plugin& shape);
/// attribute: what the colours of corners are, as Mitsuba names it: vertex_color, face_color, ...;
/// empty: vertex_color. areSrgb: as PlyAttribute has it.
FileMesh readPlyMesh(Context& context, const std::filesystem::path& file,
                     std::string_view attribute, std::optional<bool> areSrgb);

} // namespace stromboli::mitsuba
