#pragma once

#include "scene/build/mesh.hpp"
#include "scene/mitsuba/context.hpp"

#include <filesystem>

namespace stromboli::mitsuba {

/// A mesh of one part from a file of its own. Textures have v growing downwards, as everywhere in
/// the scene; what the file says of materials has no meaning.
struct FileMesh {
    build::Mesh mesh;
    bool hasCoordinates = false, hasColors = false;
};

FileMesh readObjMesh(Context& context, const std::filesystem::path& file);
/// takesFaceColors: the colours of corners are those of faces, not of vertices.
FileMesh readPlyMesh(Context& context, const std::filesystem::path& file, bool takesFaceColors);

} // namespace stromboli::mitsuba
