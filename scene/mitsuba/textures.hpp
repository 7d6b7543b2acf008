#pragma once

#include "scene/build/texels.hpp"
#include "scene/mitsuba/colors.hpp"
#include "scene/mitsuba/context.hpp"

#include <map>
#include <optional>
#include <string>
#include <tuple>
#include <vector>

namespace stromboli::mitsuba {

using build::Layout;

/// A colour that is alike everywhere, or a texture of it.
struct Shade {
    glm::dvec3 color{1.0};
    std::optional<TextureUse> texture; ///< times `color`; its slot is to be set
    std::string attribute;  ///< the mesh attribute that the texture is to be painted with
    bool isColored = false; ///< of a file of 0.x, one number stands for channels that differ
};

/// A picture that a mesh is to be painted with, before it is known which mesh.
struct Paint {
    std::string attribute; ///< as Mitsuba names it: vertex_color, ...
    Layout layout = Layout::Color;
    bool isFraction = false; ///< of light, so that it is clamped to [0, 1]
};

/// The first colour that an object states, whatever its name.
std::optional<glm::dvec3> firstColorOf(const Plugin& plugin, ColorOf what);

/// The textures of a scene.
class Textures {
  public:
    explicit Textures(Context& context) : context_(context) {}

    /// A parameter that may be a colour or a texture. One that is neither, or cannot be read, is
    /// said, and `otherwise` is taken.
    Shade shade(const Plugin& plugin, std::string_view name, ColorOf what,
                const glm::dvec3& otherwise, Layout layout = Layout::Color);
    /// The texture that a plugin of the tag texture is; nothing where its picture cannot be shown,
    /// which is said. Throws SceneError for what is no texture.
    std::optional<Shade> texture(const Plugin& texture, ColorOf what, Layout layout);
    /// The mean of a texture and its largest value in each channel, of linear light; of mesh
    /// attributes, which no one knows yet, 1.
    glm::dvec3 meanOf(const Shade& shade) const;
    glm::dvec3 mostOf(const Shade& shade) const;

    /// What TextureUse::texture stands for, where that is no texture yet; null where it is one.
    const Paint* paintOf(uint32_t texture) const;
    /// Adds a picture to the scene, as a texture that is clamped.
    uint32_t add(TextureImage image, const Plugin& shape);

    /// 1 minus so many times what a texture has in red, as another texture in red; nothing for mesh
    /// attributes.
    std::optional<TextureUse> complementOf(const TextureUse& use, double factor);

    /// Width and height in texels.
    glm::uvec2 sizeOf(const TextureUse& use) const;

  private:
    std::optional<Shade> bitmap(const Plugin& texture, Layout layout);
    Shade checkerboard(const Plugin& texture, ColorOf what, Layout layout);
    Shade grid(const Plugin& texture, ColorOf what, Layout layout);
    std::optional<Shade> scaled(const Plugin& texture, ColorOf what, Layout layout);
    std::optional<Shade> unknown(const Plugin& texture, ColorOf what, Layout layout);
    /// A picture of the scene; no number: it cannot be shown.
    struct Read {
        std::optional<uint32_t> image;
        bool isColored = false; ///< one number stands for channels that differ (Mitsuba 0.x)
    };
    Read image(const Plugin& texture, bool raw, Layout layout, char channel);
    Shade meanOfVolume(const Plugin& texture);
    Shade meshAttribute(const Plugin& texture, const std::string& name, Layout layout);
    glm::dvec3 colorNamed(const Plugin& pattern, const char* name, ColorOf what, double otherwise,
                          Layout layout);
    Shade shown(const Plugin& texture, TextureImage image, bool isNearest);
    void countBytes(const TextureImage& image, const Plugin& plugin);

    static constexpr uint32_t kFirstPaint = 0x80000000u;

    Context& context_;
    /// By file, whether it is raw, layout, channel, the power that decodes it and whether it is of
    /// means.
    std::map<std::tuple<std::string, bool, Layout, char, double, bool>, Read> images_;
    std::vector<Paint> paints_; ///< of numbers of textures from kFirstPaint on
    uint64_t bytes_ = 0;        ///< of all pictures
};

} // namespace stromboli::mitsuba
