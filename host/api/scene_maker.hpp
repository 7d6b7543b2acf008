#pragma once

#include "scene/build/scene_builder.hpp"
#include "scene/model/scene.hpp"

#include <glm/glm.hpp>

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

namespace stromboli::api {

/// A mesh in arrays that the caller has; they are copied.
struct MeshArrays {
    std::string name;
    std::span<const double> positions;   ///< x, y, z of each vertex
    std::span<const uint32_t> triangles; ///< three vertices of each, counter-clockwise in front
    std::span<const double> normals;     ///< x, y, z of each vertex; empty: shaded flat
    std::span<const double> uvs;         ///< u, v of each vertex, (0, 0) is the upper left corner
    uint32_t material = 0;
    glm::dmat4 toWorld{1.0};
};

/// A light that is not the emission of a surface. `kind` says which members have a meaning.
struct LightAsked {
    std::string kind; ///< directional, point, spot, ambient or area
    std::string name;
    /// directional: irradiance; point, spot: intensity; ambient, area: radiance.
    glm::dvec3 color{1.0};
    glm::dvec3 position{0.0};         ///< point, spot; area: the middle of the rectangle
    glm::dvec3 direction{0, -1, 0};   ///< directional, spot, area: where the light goes
    glm::dvec2 size{1.0};             ///< area: of the rectangle, metres
    double angle = 90;                ///< spot: full angle of the cone, degrees
    std::optional<double> innerAngle; ///< spot: of the cone in which it is undiminished
};

/// A camera of a scene.
struct CameraAsked {
    std::string name;
    glm::dvec3 from{0.0}, at{0, 0, -1}, up{0, 1, 0};
    double fov = 40; ///< over the height of the picture, degrees
    double aperture = 0, focus = 1;
};

/// Makes a scene in memory (y up, metres). What all loaders have in common is done to it too: far
/// scenes are moved to the origin, triangles without area are left out and said, area lights become
/// geometry, and a scene without light gets a sky. Functions throw UsageError for what makes no
/// sense: wrong sizes, vertices and materials that are not there, numbers that are not finite.
class SceneMaker {
  public:
    explicit SceneMaker(std::string name) : name_(std::move(name)) {}

    /// Returns its number, from 0.
    uint32_t addMaterial(Material material);
    /// To set its parameters, until finish().
    Material& material(uint32_t number);
    /// A picture of `width` x `height` texels of three (R, G, B) or four (and alpha) bytes, from
    /// the top. Red, green and blue are sRGB or linear. Returns its number.
    uint32_t addTexture(uint32_t width, uint32_t height, std::span<const uint8_t> bytes, bool srgb);
    /// Likewise of linear floats, from -65504 to 65504: they are kept in 16 bits.
    uint32_t addTexture(uint32_t width, uint32_t height, std::span<const float> values);
    /// The texture multiplies base_color, roughness_metallic, emission, or is the map of normals
    /// ("normal").
    void useTexture(uint32_t material, std::string_view slot, uint32_t texture);
    void addMesh(const MeshArrays& mesh);
    void addSphere(const std::string& name, const glm::dvec3& center, double radius,
                   uint32_t material);
    void addLight(const LightAsked& light);
    void addCamera(const CameraAsked& camera);
    /// An equirectangular picture of `width` x `height` radiances (three numbers each), from the
    /// top; 1 x 1: the same from everywhere. rotation: degrees about +y.
    void setEnvironment(uint32_t width, uint32_t height, std::span<const float> radiance,
                        double strength, double rotation);

    /// The scene; the maker is empty afterwards. Throws SceneError.
    std::shared_ptr<Scene> finish();

  private:
    struct Shape {
        std::string name;
        std::variant<build::Mesh, double> form; ///< double: the radius of a sphere
        glm::dmat4 toWorld{1.0};
        uint32_t material = 0;
    };
    void requireMaterial(uint32_t number) const;
    /// A picture of that size without texels, and how many channels `count` numbers make.
    std::pair<TextureImage, size_t> textureOf(uint32_t width, uint32_t height, size_t count,
                                              const char* what) const;

    std::string name_;
    std::vector<Material> materials_;
    std::vector<TextureImage> images_;
    std::vector<bool> isSrgb_; ///< by image
    std::vector<Shape> shapes_;
    std::vector<LightAsked> lights_;
    std::vector<CameraAsked> cameras_;
    std::optional<Environment> environment_;
};

} // namespace stromboli::api
