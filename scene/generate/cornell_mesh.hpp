#pragma once

#include "scene/generate/strip_mesh.hpp"
#include "scene/model/scene.hpp"

#include <string>
#include <vector>

namespace stromboli {

/// A gnarled knot with smooth normals in a Cornell box of 2 m: what scene/library/cornell_mesh.dae
/// holds, and larger scenes that look the same. Millimetres, y up.
struct CornellMesh {
    struct Surface {
        std::string name;
        glm::dvec3 albedo, emission;
    };
    struct Wall {
        std::string name, surface;
        glm::dvec3 corners[4]; ///< counter-clockwise seen from inside the box
    };

    /// Looks along -z at the middle of the box.
    struct View {
        double fieldOfView = 30; ///< degrees, horizontal
        double nearDistance = 1, farDistance = 100000;
        double distance = 5200; ///< from the middle of the box
    };
    static constexpr double kMetresPerUnit = 0.001;

    std::vector<Surface> surfaces;
    std::vector<Wall> walls; ///< the emitter among them
    StripMesh knot;          ///< on the floor
    std::string knotSurface;
    View view;
};

/// The knot has 2 * along * around triangles; 500 times 50 in the library's file.
CornellMesh cornellMesh(uint32_t along, uint32_t around);

/// The text of scene/library/cornell_mesh.dae: positions rounded to a tenth of a millimetre,
/// normals to three digits.
std::string cornellMeshText(const CornellMesh& mesh);

/// What the loader would make of the text, were it not rounded. `source` becomes Scene::file.
Scene cornellMeshScene(const CornellMesh& mesh, const std::string& source);

} // namespace stromboli
