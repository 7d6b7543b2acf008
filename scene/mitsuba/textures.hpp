#pragma once

#include "scene/mitsuba/colors.hpp"
#include "scene/mitsuba/context.hpp"

#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace stromboli::mitsuba {

/// Which numbers of a texel a picture's value becomes; the others are 1. Grey: red, in the
/// precision of the file where that has no colours.
enum class Layout { Color, Alpha, Red, Green, Blue, Grey };

/// A colour that is alike everywhere, or a texture of it.
struct Shade {
    glm::dvec3 color{1.0};
    std::optional<TextureUse> texture; ///< times `color`; its slot is to be set
    std::string attribute; ///< the mesh attribute that the texture is to be painted with
};

/// A picture that a mesh is to be painted with, before it is known which mesh.
struct Paint {
    std::string attribute; ///< as Mitsuba names it: vertex_color, ...
    Layout layout = Layout::Color;
};

/// Adds a texel that holds a value where the layout says, of RgbaHalf.
void appendTexel(std::vector<uint32_t>& words, const glm::dvec3& value, Layout layout);

/// The textures of a scene.
class Textures {
  public:
    explicit Textures(Context& context) : context_(context) {}

    /// A parameter that may be a colour or a texture.
    Shade shade(const Plugin& plugin, std::string_view name, ColorOf what,
                const glm::dvec3& otherwise, Layout layout = Layout::Color);
    /// The texture that a plugin of the tag texture is.
    Shade texture(const Plugin& texture, ColorOf what, Layout layout);

    /// What TextureUse::texture stands for, where that is no texture yet; null where it is one.
    const Paint* paintOf(uint32_t texture) const;
    /// Adds a picture to the scene, as a texture that is clamped.
    uint32_t add(TextureImage image, const Plugin& shape);

    /// Width and height in texels.
    glm::uvec2 sizeOf(const TextureUse& use) const;

  private:
    Shade bitmap(const Plugin& texture, Layout layout);
    Shade checkerboard(const Plugin& texture, ColorOf what, Layout layout);
    uint32_t image(const Plugin& texture, bool raw, Layout layout);
    Shade meshAttribute(const Plugin& texture, Layout layout);
    void countBytes(const TextureImage& image, const Plugin& plugin);

    static constexpr uint32_t kFirstPaint = 0x80000000u;

    Context& context_;
    std::map<std::tuple<std::string, bool, Layout>, uint32_t> images_;
    std::vector<Paint> paints_; ///< of numbers of textures from kFirstPaint on
    uint64_t bytes_ = 0;        ///< of all pictures
};

} // namespace stromboli::mitsuba
