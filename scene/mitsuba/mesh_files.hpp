#pragma once

#include "scene/build/mesh.hpp"
#include "scene/mitsuba/context.hpp"

#include <filesystem>
#include <string_view>

namespace stromboli::mitsuba {

/// A mesh of one part from a file of its own. Textures have v growing downwards, as everywhere in
/// the scene; what the file says of materials has no meaning.
struct FileMesh {
    build::Mesh mesh;
    bool hasCoordinates = false, hasColors = false;
};

FileMesh readObjMesh(Context& context, const std::filesystem::path& file);
/// attribute: what the colours of corners are, as Mitsuba names it: vertex_color, face_color, ...;
/// empty: vertex_color.
FileMesh readPlyMesh(Context& context, const std::filesystem::path& file,
                     std::string_view attribute);

} // namespace stromboli::mitsuba
