#pragma once

#include "host/bvh/cpu_traversal.hpp"
#include "host/bvh/wide_layout.hpp"
#include "scene/model/scene.hpp"
#include "tests/bvh/random.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace stromboli::test {

/// A scene with its tree, ready for rays.
struct Traceable {
    explicit Traceable(Scene scene, const BuildOptions& options = {});

    /// One scene primitive alone, corners in the order its leaf has them.
    std::optional<PrimitiveHit> hitPrimitive(uint32_t primitive, const PreparedRay& ray, float tMin,
                                             float tMax) const;

    Scene scene;
    WideLayout layout;
    std::vector<uint32_t> primitiveAt; ///< by place
};

void addTriangle(Scene& scene, const glm::vec3& a, const glm::vec3& b, const glm::vec3& c);

/// Triangles and spheres of extent about `size` in the cube [-1, 1]^3.
Scene soup(uint32_t triangles, uint32_t spheres, float size, Random& random);

/// A closed mesh that every ray from its middle meets once: an octahedron, each triangle divided
/// into 4^levels, pushed out to the unit sphere and back to random radii in [0.6, 1.4]. Corners
/// are shared.
Scene starMesh(uint32_t levels, Random& random);

/// The surface of the cube [-1, 1]^3 with n x n squares of two triangles on each face: its edges
/// lie in the planes of its boxes. Corners are shared.
Scene cubeMesh(uint32_t n);

/// Triangles of a rolling landscape of n x n squares above [-1, 1]^2.
Scene landscape(uint32_t n);

/// Many tiny triangles in a corner of a large sparse soup ("teapot in a stadium").
Scene clusterInSoup(Random& random);

/// Long thin triangles side by side, in order.
Scene sliverStrip(uint32_t n);

/// The boxes of its triangles and spheres.
std::vector<Bounds> boxesOf(const Scene& scene);

/// The inside of a room [-1, 1]^3 of two triangles a side.
void addRoom(Scene& scene);

/// Each position moved by `by`, then rounded to float.
void translate(Scene& scene, const glm::vec3& by);

/// Positions and radii multiplied by the factor, then rounded to float.
void scale(Scene& scene, float factor);

} // namespace stromboli::test
