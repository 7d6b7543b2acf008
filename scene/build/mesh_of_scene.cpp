#include "scene/build/mesh_of_scene.hpp"

namespace stromboli::build {

Mesh meshOfScene(const Scene& scene) {
    Mesh mesh;
    mesh.positions.assign(scene.positions.begin(), scene.positions.end());
    mesh.normals.assign(scene.normals.begin(), scene.normals.end());
    mesh.attributes = scene.attributes;
    MeshPart& part = mesh.parts.emplace_back();
    part.reserve(scene.triangles.size());
    for (size_t i = 0; i < scene.triangles.size(); ++i) {
        const Triangle& t = scene.triangles[i];
        MeshTriangle& triangle = part.emplace_back();
        for (size_t k = 0; k < 3; ++k)
            triangle[k] = {t.corner[k], t.normals[k],
                           scene.attributeCorners.empty() ? kNoAttributes
                                                          : scene.attributeCorners[i][k]};
    }
    return mesh;
}

} // namespace stromboli::build
