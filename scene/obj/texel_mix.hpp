#pragma once

#include "scene/model/texture.hpp"
#include "scene/obj/mtl_file.hpp"

namespace stromboli::obj {

/// One number a texel of a picture. Without a picture all of them are 1.
struct ChannelSource {
    const TextureImage* image = nullptr;
    MapChannel channel = MapChannel::Unstated;
};

/// The channel that a map means: the one it states, or else alpha where that is not 1 everywhere,
/// or else luminance.
MapChannel resolvedChannel(const TextureImage& image, MapChannel stated, bool mayBeAlpha);

/// A picture with these colours (null: white) and this opacity, of the larger of the two sizes; the
/// other one is enlarged by repeating texels.
TextureImage withAlpha(const TextureImage* color, const ChannelSource& alpha);

/// A picture of glTF's MetallicRoughness: green is roughness, blue metallic.
TextureImage roughnessMetallic(const ChannelSource& roughness, const ChannelSource& metallic);

} // namespace stromboli::obj
