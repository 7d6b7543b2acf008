#pragma once

#include "scene/build/conventions.hpp"
#include "scene/build/file_place.hpp"
#include "scene/build/mesh.hpp"
#include "scene/build/mesh_placer.hpp"
#include "scene/build/mesh_uses.hpp"
#include "scene/build/report.hpp"
#include "scene/model/scene.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace stromboli::build {

/// What surfaces are made of that have no material: it reflects half of the light, diffusely.
Material greyMaterial();

/// A mesh or sphere that a file defines once and shows any number of times.
enum class ShapeId : size_t {};

/// Makes a Scene of what a loader reads: a loader parses its format, hands over materials, shapes,
/// lights and cameras with the matrices that place them in the world (y up, metres), and asks for
/// the scene. What all formats have in common is here: precision, ranges, orientation, conventions,
/// and the report of what was left out.
class SceneBuilder {
  public:
    /// `file`: the scene's name, for messages.
    SceneBuilder(std::string file, const SceneConventions& conventions);

    const SceneConventions& conventions() const { return conventions_; }
    Report& report() { return report_; }

    /// The file has elements of the dialect CGL (Scene::cglDialect).
    void markCglDialect() { scene_.cglDialect = true; }

    /// Pictures of emission are lamps, as the file says, and no ornaments: however weak they are,
    /// the scene gets no default light beside them.
    void picturesOfEmissionAreLamps() { picturesAreLamps_ = true; }

    /// Light from all around.
    void setEnvironment(Environment environment) { scene_.environment = std::move(environment); }
    /// A rectangle in the world through which the sky's light comes.
    void addPortal(const glm::dvec3& corner, const glm::dvec3& edgeA, const glm::dvec3& edgeB);
    /// How the file wants to be rendered.
    RenderHints& hints() { return scene_.hints; }

    /// Returns the number by which parts of meshes name the material.
    uint32_t addMaterial(Material material);
    /// Return the numbers by which textures name the picture, and materials the texture.
    uint32_t addImage(TextureImage image);
    uint32_t addTexture(const Texture& texture);
    /// The picture of a texture that was added.
    const TextureImage& imageOf(uint32_t texture) const;
    const Texture& textureOf(uint32_t texture) const { return scene_.textures.at(texture); }
    /// The material of surfaces that name none: mid grey.
    uint32_t defaultMaterial();
    /// A fraction of light per channel: negative ones and NaN become 0 and those above 1 become 1
    /// (unless the conventions keep them), with a warning, since a surface that reflects more than
    /// it receives has no picture. `what` is the name the file gives it.
    glm::vec3 reflectedFraction(std::string_view what, const glm::vec3& color);
    /// A radiance or other amount of light: channels that are negative or not
    /// finite become 0, with a warning.
    glm::vec3 lightColor(std::string_view what, const glm::vec3& color);

    /// Returns the number by which materials and cameras name the medium. Coefficients that are
    /// negative or not finite become 0, and the asymmetry is kept in its range; both are said. The
    /// densities of a grid lie in the world's coordinates.
    uint32_t addMedium(Medium medium);

    /// `name`: of the shape in the file, for messages.
    ShapeId addMesh(std::string name, Mesh mesh);
    /// A sphere about its own origin. Where it is placed so that it is none, it is a polyhedron
    /// (sphereMesh()); in the dialect CGL it stays one, of the radius that its x axis has, as
    /// CS184's programs have it.
    ShapeId addSphere(std::string name, double radius);

    /// Adds a new instance of a shape, transformed to the world. `materials` has one number per
    /// part of the mesh; a sphere has one part. Triangles are turned as Winding says; those without
    /// area or beyond the range of coordinates are left out and counted. Meshes are placed by
    /// finish(), which knows how often each is shown.
    void place(const FilePlace& where, ShapeId shape, const glm::dmat4& toWorld,
               std::span<const uint32_t> materials, const std::string& instanceName);
    /// The instance that was placed last is moved by an animation.
    void markMoving();
    /// So are lights.
    void markMovingLights() { scene_.lightsMove = true; }

    /// Adds a light with name, kind, colour and falloff set; the matrix gives its place and aim:
    /// it shines along its own -z axis, and a rectangle spans its x and y axes from -1/2 to 1/2.
    /// Lights without a place or a direction in the world (a singular matrix, coordinates beyond
    /// 2^60) are left out with a warning.
    void placeLight(Light light, const glm::dmat4& toWorld);

    /// Adds a camera with name, projection, extents and depth range set, in lengths of its own
    /// space; the matrix gives its pose (it looks along its own -z axis, +y up) and scales its
    /// lengths. A camera whose matrix is singular is left out with a warning.
    /// isMirrored: its picture is a mirror image, x pointing to the left.
    void placeCamera(FileCamera camera, const glm::dmat4& toWorld, bool isMirrored = false);

    /// The scene, with its report; nothing can be added after. A scene that has something to light
    /// and nothing that lights it gets the default light, where the conventions have one. Throws
    /// SceneError (at a mesh's place) if the scene gets too large.
    Scene finish();

  private:
    struct Shape {
        std::string name;
        std::variant<Mesh, double> form;  ///< double: the radius of a sphere
        std::optional<ShapeId> stretched; ///< of a sphere: the mesh that is placed where it is none
        Drops drops;
    };

    glm::dmat4 standing(const glm::dmat4& toWorld) const;
    void placeStanding(const FilePlace& where, ShapeId shape, const glm::dmat4& toWorld,
                       std::span<const uint32_t> materials, const std::string& instanceName);
    uint32_t startInstance(const std::string& name);
    void centreMeshes();
    void moveOrigin();
    void placeMeshes();
    bool staysSphere(double radius, const glm::dmat4& toWorld) const;
    ShapeId stretchedSphere(ShapeId sphere);
    void placeSphere(double radius, const glm::dmat4& toWorld, uint32_t material,
                     const std::string& instanceName, Drops& drops);
    void reportDrops(const Shape& shape);
    void lightTheDark();
    void sayClamped(const std::string& line);
    void clampReflectance();

    SceneConventions conventions_;
    Scene scene_;
    Report report_;
    std::vector<Shape> shapes_;
    std::vector<MeshUse> meshes_; ///< that finish() is to place
    std::vector<glm::dvec3> sphereCenters_, lightPlaces_,
        portalCorners_; ///< of the scene's, not yet rounded
    std::optional<FilePlace> tooLargeAt_;
    uint64_t copiedTriangles_ = 0; ///< if each use of a mesh were a copy
    std::optional<uint32_t> defaultMaterial_;
    bool picturesAreLamps_ = false;
};

} // namespace stromboli::build
