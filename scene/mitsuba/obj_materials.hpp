#pragma once

#include "scene/mitsuba/materials.hpp"
#include "scene/mitsuba/mesh_files.hpp"

namespace stromboli::mitsuba {

/// An OBJ file brings materials of its own into a scene of Mitsuba 0.x, where its shape names none,
/// or has bsdfs of the names of the file's.
bool usesOwnMaterials(const Plugin& shape);

/// The shape's bsdf for a material of the file: that of its name, or the one without a name; null
/// where there is neither.
const Plugin* bsdfFor(const Plugin& shape, const std::string& material);

/// The materials of a file's triangles: adds those that the shape does not name to the scene, and
/// cuts the mesh into one part for each. Returns their numbers.
std::vector<BoundMaterial> bindOwnMaterials(Context& context, Materials& materials,
                                            const Plugin& shape, const FileMesh& file,
                                            build::Mesh& mesh);

} // namespace stromboli::mitsuba
