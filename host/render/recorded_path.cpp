#include "host/render/recorded_path.hpp"

namespace stromboli {

glm::dvec3 sumOf(const RecordedPath& path) {
    glm::dvec3 sum(0.0);
    for (const RecordedVertex& vertex : path.vertices) {
        glm::dvec3 here = vertex.light;
        for (const RecordedLight& light : vertex.lights)
            here += light.light;
        sum += vertex.branch == 0 ? here : here / double(path.branches);
    }
    return path.filterWeight * sum;
}

} // namespace stromboli
