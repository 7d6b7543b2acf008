#pragma once

#include "scene/mitsuba/mesh_files.hpp"

#include <string>

namespace stromboli::mitsuba {

/// The mesh with that number of a file in Mitsuba's own format, of version 3 or 4. `name` is for
/// messages. Throws SceneError.
FileMesh serializedMesh(const std::string& bytes, const std::string& name, uint64_t number,
                        build::Report& report);

} // namespace stromboli::mitsuba
