#pragma once

#include "scene/model/scene.hpp"

#include <cstdint>
#include <vector>

namespace stromboli {

enum class EmitterKind : uint32_t {
    Quad, ///< two triangles that form a parallelogram, alike everywhere: corner + u edgeA + v edgeB
    Mesh, ///< any other set of triangles
    Sphere, ///< one sphere
};

/// Emissive geometry sampled as one light: all triangles of one instance with one emissive
/// material, or one sphere. `-l N` gives each of them N samples per shading point.
struct Emitter {
    EmitterKind kind = EmitterKind::Mesh;
    uint32_t material = 0;
    std::vector<uint32_t> triangles;                  ///< Quad, Mesh: into Scene::triangles
    uint32_t sphere = 0;                              ///< Sphere: into Scene::spheres
    glm::vec3 corner{0.0f}, edgeA{0.0f}, edgeB{0.0f}; ///< Quad; normal = edgeA x edgeB
    double area = 0;                                  ///< of one side, world units squared
};

/// From this many emissive triangles on, those of all quads and meshes of a scene are one light, of
/// which a sample takes one triangle by its likely contribution.
inline constexpr size_t kManyEmissiveTriangles = 64;
bool haveManyTriangles(const std::vector<Emitter>& emitters);

/// Groups the emissive geometry of a scene, in the order of instances. Deterministic.
std::vector<Emitter> collectEmitters(const Scene& scene);

} // namespace stromboli
