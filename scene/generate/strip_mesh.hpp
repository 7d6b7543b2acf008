#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace stromboli {

/// Triangle strips as COLLADA's <tristrips> has them: in a strip a b c d the triangles are a b c
/// and c b d. Counter-clockwise seen from outside.
using Strip = std::vector<uint32_t>;

/// A mesh with a normal for every position.
struct StripMesh {
    std::vector<glm::dvec3> positions, normals;
    std::map<std::string, std::vector<Strip>> strips; ///< by material

    size_t triangleCount() const {
        size_t count = 0;
        for (const auto& [material, group] : strips)
            for (const Strip& strip : group)
                count += strip.size() - 2;
        return count;
    }
};

} // namespace stromboli
