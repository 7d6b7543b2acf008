#pragma once

#include "scene/gltf/context.hpp"

#include <array>
#include <map>
#include <optional>
#include <utility>

namespace stromboli::gltf {

/// Two sets of texture coordinates of the file, TEXCOORD_n, that corners have for a material.
struct UvSets {
    std::array<uint32_t, 2> sets = {0, 1};
    std::array<bool, 2> used = {false, false};
};

/// Textures and pictures of a file, each of which is read when a material uses it.
class Textures {
  public:
    explicit Textures(Context& context) : context_(context) {}

    /// The texture that a material's member (a textureInfo) names, with its transformation, for a
    /// slot; nothing if the member is not there or the texture cannot be shown. `srgb`: its colours
    /// are sRGB. `uvSets` are those of the material.
    std::optional<TextureUse> use(const Element& parent, std::string_view member, TextureSlot slot,
                                  bool srgb, UvSets& uvSets);
    /// As use(), for a member whose alpha, times `glossiness`, is how smooth the surface is: a
    /// texture of MetallicRoughness that says how rough it is.
    std::optional<TextureUse> useGlossiness(const Element& parent, std::string_view member,
                                            double glossiness, UvSets& uvSets);

  private:
    /// What textures are made of beside their pictures.
    struct Reading {
        bool srgb = false;
        std::optional<double> glossiness; ///< the picture's alpha times that becomes roughness
        auto operator<=>(const Reading&) const = default;
    };

    std::optional<TextureUse> use(const Element& parent, std::string_view member, TextureSlot slot,
                                  const Reading& reading, UvSets& uvSets);
    std::optional<uint32_t> textureOrNone(size_t index, const Reading& reading);
    std::optional<uint32_t> texture(size_t index, const Reading& reading);
    std::optional<size_t> sourceOf(const Element& texture);
    std::optional<uint32_t> image(size_t index, const Reading& reading);
    /// From where the conventions keep it, if it is there.
    TextureImage readOnce(size_t index, bool srgb);
    /// Shrunk to the largest size that is wanted.
    TextureImage readToFit(size_t index, bool srgb);
    TextureImage read(size_t index, bool srgb);
    TextureImage decoded(std::string_view bytes, const std::string& name, bool srgb,
                         const Element& at);
    void requireRoom(uint64_t bytes, size_t index);

    Context& context_;
    std::map<std::pair<size_t, Reading>, std::optional<uint32_t>> textures_;
    std::map<std::pair<size_t, Reading>, uint32_t> images_;
    uint64_t bytes_ = 0; ///< of all pictures that are kept
};

} // namespace stromboli::gltf
