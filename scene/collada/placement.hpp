#pragma once

#include "scene/collada/context.hpp"
#include "scene/collada/mesh.hpp"

#include <glm/glm.hpp>

#include <cstddef>
#include <span>
#include <string>

namespace stromboli::collada {

/// What was left out of a mesh or sphere, in all its instances.
struct Drops {
    size_t triangles = 0;  ///< looked at
    size_t zeroArea = 0;   ///< triangles left out because their corners are on one line
    size_t outOfRange = 0; ///< triangles left out because not finite or beyond 2^60
    size_t badNormals = 0; ///< triangles shaded flat because of a zero or non-finite normal
    size_t spheres = 0;    ///< left out because of their radius or because beyond 2^60

    /// One warning line for the geometry of that name, if there is anything to say.
    void reportTo(Report& report, const std::string& geometry) const;
};

/// Adds a mesh to the scene, transformed to the world, as one new instance. `materials` has one
/// index per group of the mesh. Triangles are turned so that their geometric normal lies on the
/// side of the sum of their file normals; without those, on the side their winding had before a
/// mirroring transformation. Throws SceneError (at `where`) if the scene gets too large.
void placeMesh(Context& context, const Element& where, const Mesh& mesh, const glm::dmat4& toWorld,
               std::span<const uint32_t> materials, const std::string& instanceName, Drops& drops);

/// Adds a sphere about the node's origin to the scene. Its radius is scaled as the node's x axis.
void placeSphere(Context& context, double radius, const glm::dmat4& toWorld, uint32_t material,
                 const std::string& instanceName, Drops& drops);

} // namespace stromboli::collada
