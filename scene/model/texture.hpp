#pragma once

#include <glm/glm.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace stromboli {

enum class TexelFormat : uint32_t {
    Rgba8,    ///< one word: four fractions of 255, red in the lowest byte
    RgbaHalf, ///< two words: four half floats, red in the lower half of the first; linear
};

/// A picture that surfaces are covered with. Row 0 is at the top; v = 0 is its upper edge.
struct TextureImage {
    std::string name; ///< for messages: the file, or what the scene file calls it
    uint32_t width = 0, height = 0;
    TexelFormat format = TexelFormat::Rgba8;
    std::vector<uint32_t> words; ///< width x height texels, row after row
    /// Some texels only continue what lies between others, where alone it is looked up: they may
    /// exceed what the surface can have.
    bool goesBeyond = false;
};

/// What a picture shows beyond its edges.
enum class Wrap : uint32_t { Repeat, Mirror, Clamp };

/// A picture and how it is looked up.
struct Texture {
    uint32_t image = 0; ///< into Scene::images
    Wrap wrapU = Wrap::Repeat, wrapV = Wrap::Repeat;
    bool nearest = false; ///< the nearest texel; else bilinear
    bool srgb = false;    ///< Rgba8: red, green and blue are sRGB; decoded before they are mixed
};

/// What a texture of a material changes. All but Normal, ClearcoatNormal and Height multiply the
/// number of the same name in the material; glTF's channels.
enum class TextureSlot : uint32_t {
    BaseColor,           ///< red, green, blue: Material::baseColor(); alpha: opacity
    MetallicRoughness,   ///< green: roughness, blue: metallic; of Facets alpha along and across
    Normal,              ///< tangent space, [0, 1] for [-1, 1]
    Emission,            ///< red, green, blue
    Transmission,        ///< red
    Specular,            ///< alpha
    SpecularColor,       ///< red, green, blue; Dielectric with facets, ThinDielectric, Plastic:
                         ///< reflectance
    Clearcoat,           ///< red
    ClearcoatRoughness,  ///< green
    ClearcoatNormal,     ///< as Normal
    SheenColor,          ///< red, green, blue
    SheenRoughness,      ///< alpha
    Anisotropy,          ///< red, green: direction, [0, 1] for [-1, 1]; blue: strength
    Height,              ///< red: above the surface, along its shading normal; uvSet is 0
    BlendShare,          ///< red: Material::otherShare
    Projection,          ///< of lights: red, green, blue
    Opacity,             ///< red: opacity; with a scale below 0 what is left of 1
    DiffuseTransmission, ///< alpha
    DiffuseTransmissionColor, ///< red, green, blue
    Iridescence,              ///< red
    FilmThickness,            ///< green: filmSpan
};
inline constexpr uint32_t kTextureSlotCount = 21;

/// A texture in one of a material's slots.
struct TextureUse {
    TextureSlot slot = TextureSlot::BaseColor;
    uint32_t texture = 0; ///< into Scene::textures
    uint32_t uvSet = 0;   ///< 0 or 1: which of the corners' texture coordinates
    /// From texture coordinates to the picture: u' = uRow . (u, v, 1), v' = vRow . (u, v, 1).
    glm::vec3 uRow{1, 0, 0}, vRow{0, 1, 0};
    /// Normal, ClearcoatNormal: of the tangential part. Height: what 1 stands for, in metres.
    /// Opacity: its sign alone counts.
    float scale = 1;

    bool operator==(const TextureUse&) const = default;
};

/// What the corners of triangles have beside position and normal.
struct VertexAttributes {
    glm::vec2 uv[2] = {glm::vec2(0), glm::vec2(0)};
    glm::vec4 color{1.0f}; ///< linear; multiplies baseColor (Diffuse: albedo) and opacity
    /// Unit tangent, along which u grows; w: +1 or -1, the bitangent is w (normal x tangent).
    /// w = 0: the mesh states none.
    glm::vec4 tangent{0.0f};
};

} // namespace stromboli
