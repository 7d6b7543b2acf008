#pragma once

#include <assimp/vector3.h>
#include <glm/glm.hpp>

namespace stromboli::assimp {

inline glm::dvec3 vectorOf(const aiVector3D& v) {
    return {v.x, v.y, v.z};
}

} // namespace stromboli::assimp
