#pragma once

#include "scene/model/environment.hpp"
#include "scene/model/light.hpp"
#include "scene/model/material.hpp"
#include "scene/model/portal.hpp"
#include "scene/model/render_hints.hpp"
#include "scene/model/texture.hpp"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace stromboli {

/// Axis-aligned box; the default one is empty (contains nothing, extend() makes it valid).
struct Bounds {
    glm::vec3 lo{3.402823466e38f};
    glm::vec3 hi{-3.402823466e38f};

    bool empty() const { return lo.x > hi.x; }
    void extend(const glm::vec3& p) { lo = glm::min(lo, p), hi = glm::max(hi, p); }
    void extend(const Bounds& b) { lo = glm::min(lo, b.lo), hi = glm::max(hi, b.hi); }
    glm::vec3 extent() const { return hi - lo; }
    /// Half the surface area: what the SAH needs. 0 for an empty box.
    float halfArea() const;
};

/// Marks a triangle without shading normals: it is shaded with its geometric normal.
inline constexpr uint32_t kNoNormals = 0xFFFFFFFFu;

/// Corners are indices into Scene::positions. Counter-clockwise seen from the side its geometric
/// normal points to. Loaders orient triangles so that the geometric normal lies on the side of
/// the shading normals.
struct Triangle {
    uint32_t corner[3] = {0, 0, 0};
    uint32_t normals[3] = {kNoNormals, kNoNormals, kNoNormals}; ///< into Scene::normals, or all
                                                                ///< kNoNormals
    uint32_t material = 0;                                      ///< into Scene::materials
    uint32_t instance = 0; ///< into Scene::instances: the placed mesh it came from
};

/// Marks a triangle whose corners have no attributes.
inline constexpr uint32_t kNoAttributes = 0xFFFFFFFFu;

/// Analytic sphere, outward normal.
struct Sphere {
    glm::vec3 center{0.0f};
    float radius = 1; ///< > 0
    uint32_t material = 0;
    uint32_t instance = 0;
};

/// A mesh in its own space, which is in the scene wherever a Placement puts it: a run of
/// Scene::triangles. None of them emits.
struct Prototype {
    uint32_t firstTriangle = 0, triangles = 0;
};

/// A prototype in the world.
struct Placement {
    /// Rows of the matrix from the prototype's space to the world. It has an inverse.
    std::array<glm::vec4, 3> toWorld{glm::vec4(1, 0, 0, 0), glm::vec4(0, 1, 0, 0),
                                     glm::vec4(0, 0, 1, 0)};
    uint32_t prototype = 0; ///< into Scene::prototypes
    uint32_t instance = 0;  ///< into Scene::instances; that of the prototype's triangles counts for
                            ///< nothing
};

enum class Projection : uint32_t { Perspective, Orthographic };

/// The camera as a file states it, whatever the format; scene/camera turns it into rays for a
/// picture. All in world space.
struct FileCamera {
    std::string name;
    Projection projection = Projection::Perspective;
    glm::dvec3 position{0.0};
    glm::dvec3 right{1, 0, 0}, up{0, 1, 0}, back{0, 0, 1}; ///< orthonormal; x left: mirrored
    /// Half the extents of the view: tangents of half the fields of view (perspective) or lengths
    /// in world units (orthographic). Where the file states both, a picture of another shape shows
    /// all of them and more on its longer side. Where it states one, the picture's shape gives the
    /// other. Where it states none, scene/camera has a default.
    std::optional<double> halfWidth, halfHeight;
    /// Where the middle of a perspective picture lies beside the axis, right and up, as tangents.
    glm::dvec2 shift{0.0};
    double nearDistance = 0; ///< world units along the view axis
    double farDistance = 1e30;
    /// A thin lens, in world units (scene/camera/camera.hpp); 0: a pinhole.
    double lensRadius = 0, focusDistance = 1;
    uint32_t medium = kNoMedium; ///< around the camera: into Scene::media
    /// On the view axis, one of the file's units in front of the position. A camera that frames the
    /// scene looks at it from the direction in which this lies from the
    /// origin.
    glm::dvec3 pointAhead{0, 0, -1};
};

/// What a loader skipped or dropped, for the user: each line says what, how often and why.
struct LoadReport {
    std::vector<std::string> ignored;  ///< elements of the file without effect on the picture
    std::vector<std::string> warnings; ///< things that change the picture: dropped triangles, ...
    std::vector<std::string> forgiven; ///< what breaks the format's rules, and how it was read
    std::vector<std::string> assumed;  ///< what the file leaves open, and what was taken for it
};

/// All there is to render. y is up; lengths are metres (COLLADA unit). Everything is in world space
/// but the triangles of prototypes; the world's origin is at `origin` of the file. Positions are
/// rounded to float once, so that every backend sees the same geometry.
struct Scene {
    std::string file;
    /// Where the world's origin lies in the file's coordinates (y up, metres): elsewhere than at 0
    /// where the scene is far from there, so that positions keep their digits. What users state and
    /// are shown (`--look-from`, the layer of positions) is in the file's coordinates.
    glm::dvec3 origin{0.0};
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;    ///< unit length
    std::vector<Triangle> triangles;   ///< those of prototypes come first
    std::vector<Prototype> prototypes; ///< one after the other, from the first triangle on
    std::vector<Placement> placements;
    std::vector<Sphere> spheres;
    std::vector<Material> materials;
    std::vector<Medium> media;
    /// The medium that fills the world where no surface says what is there; into `media`.
    uint32_t surrounding = kNoMedium;
    std::vector<Light> lights;
    std::vector<TextureImage> images;
    std::vector<Texture> textures;
    std::vector<VertexAttributes> attributes;
    /// For each triangle, its corners in `attributes` (or all kNoAttributes); empty if no triangle
    /// has any.
    std::vector<std::array<uint32_t, 3>> attributeCorners;
    std::optional<Environment> environment;
    /// What the file or the user says lets the sky in; empty: nothing says so.
    std::vector<Portal> portals;
    std::vector<FileCamera> cameras;    ///< in document order
    std::vector<std::string> instances; ///< names of the placed meshes and spheres
    /// By instance: whether the animation moves it that the scene is a moment of; empty: no
    /// animation is shown.
    std::vector<bool> movingInstances;
    bool lightsMove = false; ///< likewise, some of the lights
    /// What a camera that frames the scene frames, where that is not bounds(): the geometry the
    /// file states, without emitters made from area lights, and without a floor that a user asks
    /// for.
    std::optional<Bounds> framing;
    /// What else the file could be read as: names of its sets of materials, and the end of its
    /// first animation in seconds, 0 without one.
    std::vector<std::string> variants;
    double animationSeconds = 0;
    bool cglDialect =
        false; ///< the file has elements of the dialect CGL (scene/collada/cgl_dialect.hpp)
    RenderHints hints;
    LoadReport report;

    /// The first triangle that is in world space; so are all behind it.
    uint32_t firstInWorld() const {
        return prototypes.empty() ? 0
                                  : prototypes.back().firstTriangle + prototypes.back().triangles;
    }
    /// Whether an animation moves anything, lights too.
    bool isMoment() const;
    bool moves(uint32_t instance) const {
        return instance < movingInstances.size() && movingInstances[instance];
    }
    /// Triangles that a ray can meet, those of each placement counted anew.
    uint64_t placedTriangles() const;
    Bounds bounds() const; ///< of triangles and spheres in the world; lights excluded
    Bounds framed() const { return framing.value_or(bounds()); }
    glm::vec3 geometricNormal(const Triangle& t) const; ///< unit
};

} // namespace stromboli
