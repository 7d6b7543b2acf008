#pragma once

#include "host/bvh/cpu_traversal.hpp"
#include "host/bvh/wide_layout.hpp"
#include "host/core/random.hpp"
#include "scene/generate/hard_meshes.hpp"
#include "scene/model/scene.hpp"

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

/// Positions and radii multiplied by the factor, then rounded to float.
void scale(Scene& scene, float factor);

} // namespace stromboli::test
