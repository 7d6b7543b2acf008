#pragma once

#include "scene/build/mesh.hpp"
#include "scene/pbrt/context.hpp"
#include "scene/pbrt/parameters.hpp"

#include <functional>
#include <optional>
#include <string>

namespace stromboli::pbrt {

/// What a shape is in its own space: v of texture coordinates grows upwards in pictures.
struct Form {
    build::Mesh mesh;
    bool hasCoordinates = false; ///< of textures
    size_t patches = 0;          ///< of a bilinear mesh, each of which pbrt has as a shape
    /// The faces of a mesh, where some may have four corners: pbrt-v4 has these as patches.
    std::function<size_t()> countFaces;
    std::optional<double> sphereRadius; ///< a whole sphere about the origin
    /// Makes the mesh of such a sphere, which is seldom needed and large.
    std::function<build::Mesh()> makeMesh;

    void requireMesh() {
        if (mesh.parts.empty() && makeMesh) mesh = makeMesh();
    }
};

/// The form of a shape. Throws SceneError for a kind that is none, and for what makes no shape.
Form formOf(Context& context, const std::string& kind, const Parameters& shape);

/// One of the surfaces that are turned about the z axis: sphere, cylinder, disk, cone, paraboloid
/// and hyperboloid; nothing if the kind is none of them.
std::optional<Form> revolvedForm(const std::string& kind, const Parameters& shape);

/// Loop's subdivision of a mesh.
Form subdividedForm(const Parameters& shape);
/// A grid over a NURBS patch.
Form nurbsForm(const Parameters& shape);
/// A tube along a curve.
Form curveForm(const Context& context, const Parameters& shape);

/// Triangles of a list of corners; those with corners that are not there are left out.
void addTriangles(const Parameters& shape, const std::vector<double>& indices, build::Mesh& mesh);

} // namespace stromboli::pbrt
