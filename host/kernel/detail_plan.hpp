#pragma once

#include "scene/model/scene.hpp"
#include "shaders/shared/interface.h"
#include "shaders/shared/texture_types.h"

#include <array>
#include <compare>
#include <cstdint>
#include <optional>
#include <set>
#include <vector>

namespace stromboli {

/// What the kernel reads of textures, opacity and corners' attributes: that which can change the
/// picture. A texture that multiplies a parameter of 0, or an alpha mode without anything that is
/// not opaque, costs nothing.
struct DetailPlan {
    /// A picture, what is seen beyond its edges, and how it is decoded: what the rows of a texture
    /// depend on.
    struct EdgedImage {
        static constexpr uint32_t kNone = ~0u;
        uint32_t image = 0; ///< into Scene::images
        Wrap wrapU = Wrap::Repeat, wrapV = Wrap::Repeat;
        bool srgb = false;
        /// Another picture of its size, of which red, or 1 - red, is the alpha; kNone: it has its
        /// own.
        uint32_t opacityImage = kNone;
        bool opacityIsSrgb = false, opacityIsNegative = false;
        EdgedImage(const Scene& scene, const Texture& t)
            : image(t.image), wrapU(t.wrapU), wrapV(t.wrapV),
              srgb(t.srgb && scene.images[t.image].format == TexelFormat::Rgba8) {}
        /// With the alpha of a texture that is looked up alike.
        EdgedImage(const Scene& scene, const TextureUse& use, const TextureUse& opacity)
            : EdgedImage(scene, scene.textures[use.texture]) {
            const EdgedImage other(scene, scene.textures[opacity.texture]);
            opacityImage = other.image;
            opacityIsSrgb = other.srgb;
            opacityIsNegative = opacity.scale < 0;
        }
        auto operator<=>(const EdgedImage&) const = default;
    };
    /// By slot, of the first gpu::BUNDLE_MAPS slots; those there are look up pictures of one size
    /// in the same way (gpu::TEXELS_BUNDLE).
    using Bundle = std::array<std::optional<TextureUse>, gpu::BUNDLE_MAPS>;
    /// The pictures of a bundle by slot, and what is seen beyond their edges: what the rows of a
    /// bundle depend on.
    struct EdgedBundle {
        static constexpr uint32_t kNone = ~0u; ///< it has no such map
        std::array<uint32_t, gpu::BUNDLE_MAPS> images;
        Wrap wrapU = Wrap::Repeat, wrapV = Wrap::Repeat;
        EdgedBundle(const Scene& scene, const Bundle& bundle);
        auto operator<=>(const EdgedBundle&) const = default;
    };
    struct MaterialPlan {
        std::optional<Bundle> bundle;
        std::vector<TextureUse> textures;  ///< that are in no bundle, in the order of their slots
        std::optional<TextureUse> opacity; ///< that texels of the base colour hold as their alpha
        bool isTransparent = false;        ///< may be partly not there
        bool isHidden = false;             ///< camera rays pass it
        bool isBlend = false;              ///< another material may take its place
        bool coatHasNormal = false;        ///< gpu::DETAIL_COAT_HAS_NORMAL
        bool operator==(const MaterialPlan&) const = default;
    };
    std::vector<MaterialPlan> materials; ///< by material of the scene
    std::set<EdgedImage> plainImages;    ///< of textures in no bundle: gpu::TEXELS_PLAIN
    std::set<uint32_t> fractionImages;   ///< of half floats, which gathered rows hold as fractions

    uint32_t textureSlots = 0; ///< bit n: a texture in gpu::TEXTURE_ slot n
    uint32_t looseSlots = 0;   ///< the same of textures in no bundle
    uint32_t texelKinds = 0;   ///< gpu::TEXEL_KIND_ bits
    uint32_t attributes = 0;   ///< gpu::ATTRIBUTE_ bits
    uint32_t mostTextures = 0; ///< that a material has in no bundle
    bool hasAlpha = false;     ///< some surface may be passed
    bool hasHidden = false;
    bool hasBlends = false;
    bool hasTangentFrames = false; ///< a BSDF depends on the direction of tangents

    bool operator==(const DetailPlan&) const = default;
    /// gpu::TEXELS_HALF
    bool isHalf(const Scene& scene, const Texture& texture) const;
    bool hasBundles() const { return (texelKinds & gpu::TEXEL_KIND_BUNDLE) != 0; }
    /// Materials have a gpu::MaterialDetail.
    bool hasMaterialDetails() const { return textureSlots != 0 || hasAlpha || hasBlends; }
};

/// Half of the rows that the largest texel buffers have (gpu::TEXEL_ROW_MASK), one GiB.
inline constexpr uint64_t kUsualGatheredRows = uint64_t(1) << 26;

/// used: by material, whether a primitive has it. gatheredRows: how many rows there may be of
/// textures that are stored so that a row holds texels that are looked up together, which takes
/// four times the memory of their pictures; textures that would take more are stored plainly.
DetailPlan planDetails(const Scene& scene, const std::vector<bool>& used,
                       uint64_t gatheredRows = kUsualGatheredRows);

} // namespace stromboli
