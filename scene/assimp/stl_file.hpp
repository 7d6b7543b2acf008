#pragma once

#include "scene/build/report.hpp"

#include <glm/glm.hpp>

#include <optional>
#include <string>

namespace stromboli::assimp {

/// An STL file in the one form of its kind that Assimp understands.
struct StlFile {
    std::string bytes;
    std::optional<glm::vec3> color; ///< linear; of all facets, where the header states it
};

/// Assimp refuses a binary file whose length is not what its number of triangles makes it, and text
/// that does not begin with its first keyword in small letters; and it takes colours of Materialise
/// Magics for absent where they are there. What is forgiven is said. Throws SceneError if there are
/// no triangles.
StlFile stlForAssimp(std::string bytes, const std::string& file, build::Report& report);

} // namespace stromboli::assimp
