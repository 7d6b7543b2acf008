#pragma once

#include "scene/build/conventions.hpp"
#include "scene/build/mesh.hpp"
#include "scene/model/scene.hpp"

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace stromboli::build {

/// What was left out of a mesh or sphere, in all its instances.
struct Drops {
    size_t triangles = 0;   ///< looked at
    size_t zeroArea = 0;    ///< triangles left out because their corners are on one line
    size_t outOfRange = 0;  ///< triangles left out because not finite or beyond 2^60
    size_t badNormals = 0;  ///< triangles shaded flat because of a zero or non-finite normal
    size_t badTangents = 0; ///< corners whose stated tangent is zero or not finite
    size_t spheres = 0;     ///< left out because of their radius or because beyond 2^60
};

/// Adds the triangles of one instance of a mesh to the scene, and of its positions, normals and
/// attributes those that they use.
class MeshPlacer {
  public:
    /// `scene`, `mesh` and `drops` must outlive the placer.
    MeshPlacer(Scene& scene, const SceneConventions& conventions, const Mesh& mesh,
               const glm::dmat4& toWorld, Drops& drops);

    void add(MeshTriangle corners, uint32_t material, uint32_t instance);

  private:
    bool chooseNormals(MeshTriangle& corners, const glm::dvec3 points[3], glm::dvec3 g,
                       double twiceArea);
    uint32_t positionIndex(uint32_t index);
    uint32_t normalIndex(uint32_t index);
    void addAttributes(const MeshTriangle& corners);
    uint32_t attributesIndex(uint32_t index);

    Scene& scene_;
    const Mesh& mesh_;
    Drops& drops_;
    glm::dmat3 linear_;    ///< transforms tangents
    bool flipsBitangents_; ///< the transformation turns right-handed frames into left-handed ones
    bool recomputed_;      ///< normals, one per position
    bool turnsToNormals_;  ///< triangles whose corners run the other way round
    bool mirrored_;        ///< corners run the other way round after transformation
    /// What the renderer will see. Rounded in memory once: g++ 12 drops the rounding of a vector of
    /// doubles to float and back within one expression (-ftree-slp-vectorize).
    std::vector<glm::vec3> points_;
    std::vector<glm::dvec3> normals_; ///< unit, or zero where there is none
    std::vector<uint32_t> scenePosition_, sceneNormal_, sceneAttributes_;
};

} // namespace stromboli::build
