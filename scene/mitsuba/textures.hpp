#pragma once

#include "scene/mitsuba/colors.hpp"
#include "scene/mitsuba/context.hpp"

#include <map>
#include <optional>
#include <string>
#include <tuple>

namespace stromboli::mitsuba {

/// Which numbers of a texel a picture's value becomes; the others are 1. Grey: red, in the
/// precision of the file where that has no colours.
enum class Layout { Color, Alpha, Red, Green, Blue, Grey };

/// What of a mesh the colours of its corners are.
enum class MeshColors { None, OfVertices, OfFaces };

/// A colour that is alike everywhere, or a texture of it.
struct Shade {
    glm::dvec3 color{1.0};
    std::optional<TextureUse> texture;  ///< times `color`; its slot is to be set
    MeshColors mesh = MeshColors::None; ///< in place of a texture: the colours of corners
};

/// The textures of a scene.
class Textures {
  public:
    explicit Textures(Context& context) : context_(context) {}

    /// A parameter that may be a colour or a texture.
    Shade shade(const Plugin& plugin, std::string_view name, ColorOf what,
                const glm::dvec3& otherwise, Layout layout = Layout::Color);
    /// The texture that a plugin of the tag texture is.
    Shade texture(const Plugin& texture, ColorOf what, Layout layout);

    /// Width and height in texels.
    glm::uvec2 sizeOf(const TextureUse& use) const;

  private:
    Shade bitmap(const Plugin& texture, Layout layout);
    Shade checkerboard(const Plugin& texture, ColorOf what, Layout layout);
    uint32_t image(const Plugin& texture, bool raw, Layout layout);

    Context& context_;
    std::map<std::tuple<std::string, bool, Layout>, uint32_t> images_;
    uint64_t bytes_ = 0; ///< of all pictures
};

} // namespace stromboli::mitsuba
