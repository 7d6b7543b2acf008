#include "scene/generate/cornell_mesh.hpp"

#include <algorithm>
#include <cmath>
#include <span>
#include <utility>

namespace stromboli {

namespace {

/// Puts meshes into a scene as the loader does: millimetres become metres, materials are numbered
/// in the order of their first use.
class SceneMaker {
  public:
    SceneMaker(Scene& scene, const CornellMesh& mesh) : scene_(scene), mesh_(mesh) {}

    void add(const CornellMesh::Wall& wall) {
        const uint32_t first = addPositions(wall.corners);
        Triangle triangle = nextInstance(wall.name, wall.surface);
        for (uint32_t i : {1u, 2u}) {
            triangle.corner[0] = first, triangle.corner[1] = first + i;
            triangle.corner[2] = first + i + 1;
            scene_.triangles.push_back(triangle);
        }
    }

    void add(const std::string& name, const StripMesh& mesh, const std::string& surface) {
        const uint32_t position = addPositions(mesh.positions);
        const auto normal = uint32_t(scene_.normals.size());
        scene_.normals.insert(scene_.normals.end(), mesh.normals.begin(), mesh.normals.end());
        Triangle triangle = nextInstance(name, surface);
        scene_.triangles.reserve(scene_.triangles.size() + mesh.triangleCount());
        for (const auto& [material, strips] : mesh.strips)
            for (const Strip& strip : strips)
                for (size_t i = 2; i < strip.size(); ++i) {
                    const size_t odd = i % 2; // every other triangle runs the other way round
                    const uint32_t corners[3] = {strip[i - 2 + odd], strip[i - 1 - odd], strip[i]};
                    for (int c = 0; c < 3; ++c) {
                        triangle.corner[c] = position + corners[c];
                        triangle.normals[c] = normal + corners[c];
                    }
                    turnToNormals(triangle);
                    scene_.triangles.push_back(triangle);
                }
    }

  private:
    /// Where the mesh is too coarse for the bends of its surface, a triangle can face the other
    /// way than its normals.
    void turnToNormals(Triangle& t) const {
        glm::dvec3 points[3], normals(0);
        for (int c = 0; c < 3; ++c) {
            points[c] = scene_.positions[t.corner[c]];
            normals += glm::dvec3(scene_.normals[t.normals[c]]);
        }
        if (glm::dot(glm::cross(points[1] - points[0], points[2] - points[0]), normals) >= 0)
            return;
        std::swap(t.corner[1], t.corner[2]);
        std::swap(t.normals[1], t.normals[2]);
    }

    uint32_t addPositions(std::span<const glm::dvec3> positions) {
        const auto first = uint32_t(scene_.positions.size());
        for (const glm::dvec3& p : positions)
            scene_.positions.emplace_back(CornellMesh::kMetresPerUnit * p);
        return first;
    }

    /// A triangle without corners, of a mesh that is new in the scene.
    Triangle nextInstance(const std::string& name, const std::string& surface) {
        Triangle triangle;
        triangle.material = materialIndex(surface);
        triangle.instance = uint32_t(scene_.instances.size());
        scene_.instances.push_back(name);
        return triangle;
    }

    uint32_t materialIndex(const std::string& surface) {
        for (uint32_t i = 0; i < scene_.materials.size(); ++i)
            if (scene_.materials[i].name == surface) return i;
        const auto& found = *std::find_if(mesh_.surfaces.begin(), mesh_.surfaces.end(),
                                          [&](const auto& s) { return s.name == surface; });
        Material& material = scene_.materials.emplace_back();
        material.name = found.name;
        material.albedo = found.albedo;
        material.emission = found.emission;
        return uint32_t(scene_.materials.size() - 1);
    }

    Scene& scene_;
    const CornellMesh& mesh_;
};

FileCamera cameraOf(const CornellMesh::View& view) {
    constexpr double metre = CornellMesh::kMetresPerUnit;
    FileCamera camera;
    camera.name = "camera";
    camera.halfWidth = camera.halfHeight = std::tan(glm::radians(view.fieldOfView) / 2);
    camera.nearDistance = view.nearDistance * metre;
    camera.farDistance = view.farDistance * metre;
    camera.position = {0, 0, view.distance * metre};
    camera.pointAhead = camera.position - glm::dvec3(0, 0, metre);
    return camera;
}

} // namespace

Scene cornellMeshScene(const CornellMesh& mesh, const std::string& source) {
    Scene scene;
    scene.file = source;
    scene.cameras.push_back(cameraOf(mesh.view));
    SceneMaker maker(scene, mesh);
    for (const CornellMesh::Wall& wall : mesh.walls)
        maker.add(wall);
    maker.add("knot", mesh.knot, mesh.knotSurface);
    return scene;
}

} // namespace stromboli
